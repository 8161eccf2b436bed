#include "services/decision/conflict/one_step/divergence.h"

#include <cmath>

namespace fogline::conflict {

double BhattacharyyaOfMeans(const Disagreement& disagreement) {
  return NormalisedSquare(disagreement) / 4;
}

// expm1 computes 1 - exp(-x) without cancellation for readings that hardly differ.
double HellingerOfMeans(const Disagreement& disagreement) {
  return std::sqrt(-std::expm1(-BhattacharyyaOfMeans(disagreement)));
}

}  // namespace fogline::conflict
