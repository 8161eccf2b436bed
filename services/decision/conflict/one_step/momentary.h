// Measures of conflict that use only the values of a single step.
#pragma once

#include <optional>
#include <utility>

#include "services/decision/conflict/disagreement.h"

namespace fogline::conflict {

/// A measure that depends only on the disagreement of the step. Score is a function
/// double(Disagreement). The score is 0 in a step for which DisagreementSource::Next() returns no
/// disagreement, for example if a sensor has no value and such steps are skipped.
template <class Score>
class Momentary final : public ConflictMeasure {
 public:
  Momentary(const ConflictParameters& parameters, Score score)
      : source_(parameters), score_(std::move(score)) {}

  double Step(const Evidence& evidence) override {
    const std::optional<Disagreement> disagreement = source_.Next(evidence);
    return disagreement ? score_(*disagreement) : 0;
  }

  void Reset() override { source_.Reset(); }

 private:
  DisagreementSource source_;
  Score score_;
};

}  // namespace fogline::conflict
