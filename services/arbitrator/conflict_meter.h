// The Degree of Conflict in every step: from the sensors' values to a number in [0, 1].
#pragma once

#include <algorithm>
#include <memory>

#include "scenario/scenario.h"
#include "services/conflict/conflict_measure.h"
#include "services/conflict/doc.h"
#include "services/graph.h"
#include "services/policies/evidence.h"

namespace fogline {

/// DoC = 1/(1 + exp(-slope (x - centre))) of what the scenario's measure says of the conflict: of z
/// (services/conflict/doc.h), as the paper has it, or of the score x of any other row of
/// services/conflict/measures.cc. Or, with measure_scale probability, that score itself.
class ConflictMeter {
 public:
  /// @throw InputError if measure_scale takes a measure for a probability that is none
  explicit ConflictMeter(const Scenario& scenario);

  /// The values of a step. `track` is the witness of measures that need one; it is left out unless
  /// it is of the same step.
  void Observe(const radar_t& radar, const lidar_t& lidar, const track_t& track) {
    Evidence evidence{.radar = StatedBy(radar), .lidar = StatedBy(lidar), .prediction = {}};
    if (!measure_) return doc_.Observe(evidence);
    if (track.header.step == radar.header.step) {
      evidence.prediction = witness_.Prediction(track, radar, lidar);
    }
    score_ = measure_->Step(evidence);
  }

  /// Of all steps that have been observed: z in m, or the score in the measure's own unit.
  double conflict() const { return measure_ ? score_ : doc_.conflict_m(); }
  /// DoC of such a conflict.
  double DocOf(double conflict) const {
    if (is_posterior_) return std::clamp(conflict, 0.0, 1.0);
    return DegreeOfConflict(conflict, slope_, centre_);
  }
  /// Whether the DoC is the posterior probability that a sensor is wrong, by all evidence so far.
  bool is_posterior() const { return is_posterior_; }

 private:
  bool is_posterior_ = false;
  double slope_;  // of the DoC, over z or score
  double centre_;
  Doc doc_;
  Witness witness_;
  std::unique_ptr<ConflictMeasure> measure_;  // none for doc
  double score_ = 0;
};

}  // namespace fogline
