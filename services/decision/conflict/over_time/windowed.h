// Measures of conflict that use a window of the last steps.
#pragma once

#include <functional>
#include <optional>

#include "services/decision/conflict/disagreement.h"
#include "services/decision/conflict/window.h"

namespace fogline::conflict {

/// A measure that uses a window of the last steps. kValue computes a number from the Disagreement
/// of each step, and kScore computes the score from the Window of these numbers. Both functions
/// return double. `kSteps` is the parameter with the length of the window. A step for which
/// DisagreementSource::Next() returns no disagreement adds an empty entry to the window. If all
/// entries are empty, the score is 0.
template <auto kValue, auto kScore, int ConflictParameters::*kSteps>
class Windowed final : public ConflictMeasure {
 public:
  explicit Windowed(const ConflictParameters& parameters)
      : source_(parameters), values_(parameters.*kSteps) {}

  double Step(const Evidence& evidence) override {
    const std::optional<Disagreement> disagreement = source_.Next(evidence);
    values_.Push(disagreement ? std::optional(std::invoke(kValue, *disagreement)) : std::nullopt);
    return kScore(values_);
  }
  void Reset() override {
    source_.Reset();
    values_.Clear();
  }

 private:
  DisagreementSource source_;
  Window values_;
};

}  // namespace fogline::conflict
