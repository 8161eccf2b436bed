// The Degree of Conflict in every step: from the sensors' values to a number in [0, 1].
#pragma once

#include <memory>

#include "scenario/scenario.h"
#include "services/conflict/conflict_measure.h"
#include "services/conflict/doc.h"
#include "services/graph.h"
#include "services/policies/evidence.h"

namespace fogline {

/// DoC = 1/(1 + exp(-slope (x - centre))) of what the scenario's measure says of the conflict: of z
/// (services/conflict/doc.h), as the paper has it, or of the score x of any other row of
/// services/conflict/measures.cc.
class ConflictMeter {
 public:
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
  double DocOf(double conflict) const { return DegreeOfConflict(conflict, slope_, centre_); }

 private:
  double slope_;  // of the DoC, over z or score
  double centre_;
  Doc doc_;
  Witness witness_;
  std::unique_ptr<ConflictMeasure> measure_;  // none for doc
  double score_ = 0;
};

}  // namespace fogline
