#include "services/decision/conflict/one_step/divergence.h"

#include <cmath>

#include "services/decision/conflict/one_step/nis.h"

namespace fogline::conflict {

double BhattacharyyaOfMeans(const Disagreement& disagreement) {
  return NormalisedSquare(disagreement) / 4;
}

double Bhattacharyya(const Disagreement& disagreement) {
  const double product_m2 = disagreement.radar_std_m * disagreement.lidar_std_m;
  return BhattacharyyaOfMeans(disagreement) +
         std::log(disagreement.variance_m2() / (2 * product_m2)) / 2;
}

// expm1 computes 1 - exp(-x) without cancellation for readings that hardly differ.
double Hellinger(const Disagreement& disagreement) {
  return std::sqrt(-std::expm1(-Bhattacharyya(disagreement)));
}

double HellingerOfMeans(const Disagreement& disagreement) {
  return std::sqrt(-std::expm1(-BhattacharyyaOfMeans(disagreement)));
}

}  // namespace fogline::conflict
