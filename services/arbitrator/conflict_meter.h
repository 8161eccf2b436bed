// The Degree of Conflict in every step: from the sensors' values to a number in [0, 1].
#pragma once

#include <memory>
#include <optional>

#include "scenario/scenario.h"
#include "services/conflict/conflict_measure.h"
#include "services/conflict/degree_of_conflict.h"
#include "services/graph.h"
#include "services/policies/evidence.h"

namespace fogline {

/// DoC = 1/(1 + exp(-slope (x - centre))) of what the scenario's measure says of the conflict: of z
/// (degree_of_conflict.h), as the paper has it, or of the score x of any other row of
/// services/conflict/measures.cc.
class ConflictMeter {
 public:
  explicit ConflictMeter(const Scenario& scenario);

  /// The values of a step. `track` is the witness of measures that need one; it is left out unless
  /// it is of the same step.
  void Observe(const radar_t& radar, const lidar_t& lidar, const track_t& track) {
    if (measure_) return Measure(radar, lidar, track);
    const bool both = radar.valid && lidar.valid;
    if (both) last_difference_m_ = radar.range_m - lidar.range_m;
    window_.Push(both ? last_difference_m_ : MissingDifference());
  }

  /// Of all steps that have been observed: z in m, or the score in the measure's own unit.
  double conflict() const { return measure_ ? score_ : window_.Conflict(reading_); }
  /// DoC of such a conflict.
  double DocOf(double conflict) const { return DegreeOfConflict(conflict, slope_, centre_); }

 private:
  void Measure(const radar_t& radar, const lidar_t& lidar, const track_t& track);
  std::optional<double> MissingDifference() const;

  ConflictReading reading_;
  MissingLidar missing_;
  double missing_conflict_m_;
  double slope_;  // of the DoC, over z or score
  double centre_;
  ConflictWindow window_;
  std::optional<double> last_difference_m_;  // of the last step with both values
  Witness witness_;
  std::unique_ptr<ConflictMeasure> measure_;  // none for doc
  double score_ = 0;
};

}  // namespace fogline
