#include "services/decision/conflict/one_step/nis.h"

#include <cmath>
#include <optional>

namespace fogline::conflict {

double StandardisedMean(const Window& window) {
  double sum = 0;
  int count = 0;
  window.ForEach([&](double value) {
    sum += value;
    ++count;
  });
  return count > 0 ? sum / std::sqrt(count) : 0;
}

WindowedNis::WindowedNis(const ConflictParameters& parameters)
    : source_(parameters), squares_(parameters.window_steps) {}

double WindowedNis::Step(const Evidence& evidence) {
  const std::optional<Disagreement> disagreement = source_.Next(evidence);
  squares_.Push(disagreement ? std::optional(NormalisedSquare(*disagreement)) : std::nullopt);
  double sum = 0;
  int count = 0;
  squares_.ForEach([&](double square) {
    sum += square;
    ++count;
  });
  return count > 0 ? sum / count : 0;
}

void WindowedNis::Reset() {
  source_.Reset();
  squares_.Clear();
}

SignedNis::SignedNis(const ConflictParameters& parameters)
    : source_(parameters), standardised_(parameters.window_steps) {}

double SignedNis::Step(const Evidence& evidence) {
  const std::optional<Disagreement> disagreement = source_.Next(evidence);
  standardised_.Push(disagreement ? std::optional(disagreement->standardised()) : std::nullopt);
  return StandardisedMean(standardised_);
}

void SignedNis::Reset() {
  source_.Reset();
  standardised_.Clear();
}

}  // namespace fogline::conflict
