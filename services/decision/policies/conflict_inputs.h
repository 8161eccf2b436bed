// Converts the messages of a step into evidence of conflict, and the scenario into parameters of
// the conflict measures.
#pragma once

#include "scenario/sections/scenario.h"
#include "services/decision/conflict/conflict_measures.h"
#include "services/graph.h"

namespace fogline::policies {

/// Parameters of the measures from section `arbitrator` and its `transfer`. Parameters that the
/// scenario does not have are the defaults of services/decision/conflict/conflict_parameters.h.
conflict::ConflictParameters ConflictParametersOf(const ArbitratorSection& section);

/// The rows that the scenario has chosen.
const conflict::ConflictMeasureRow& RowOf(MeasureChoice choice);
const conflict::BlameMeasureRow& RowOf(BlameChoice choice);

/// Range and standard deviation as the sensor states them.
inline conflict::StatedRange StatedBy(const radar_t& radar) {
  return {.valid = radar.valid != 0, .range_m = radar.range_m, .std_m = radar.range_std_m};
}
inline conflict::StatedRange StatedBy(const lidar_t& lidar) {
  return {.valid = lidar.valid != 0, .range_m = lidar.range_m, .std_m = lidar.range_std_m};
}

/// The filter's prediction before it used the values of the step. Its range is the measured value
/// minus the innovation; its variance is the innovation's variance minus the sensor noise that the
/// filter assumes. It is computed from the radar, or from the LiDAR in a step without radar value.
/// It is not valid in the step that starts a track, nor in a step without any value.
class Witness {
 public:
  explicit Witness(const FusionSection& section);

  conflict::StatedRange Prediction(const track_t& track, const radar_t& radar,
                                   const lidar_t& lidar) const;

 private:
  double radar_variance_m2_;
  double lidar_variance_m2_;
};

}  // namespace fogline::policies
