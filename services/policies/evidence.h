// The messages of a step as evidence of conflict, and the scenario's parameters of its measures.
#pragma once

#include "scenario/scenario.h"
#include "services/conflict/measures.h"
#include "services/graph.h"

namespace fogline {

/// Sections `arbitrator` and its `transfer` as far as measures have parameters in the scenario; the
/// others are the defaults of services/conflict/parameters.h.
ConflictParameters ConflictParametersOf(const ArbitratorSection& section);

/// The scenario's rows.
const ConflictMeasureRow& RowOf(MeasureChoice choice);
const BlameMeasureRow& RowOf(BlameChoice choice);

/// Range and standard deviation as the sensor states them.
inline StatedRange StatedBy(const radar_t& radar) {
  return {.valid = radar.valid != 0, .range_m = radar.range_m, .std_m = radar.range_std_m};
}
inline StatedRange StatedBy(const lidar_t& lidar) {
  return {.valid = lidar.valid != 0, .range_m = lidar.range_m, .std_m = lidar.range_std_m};
}

/// What the filter predicted before it used the values of its step: measured value less innovation,
/// with the innovation's variance less the noise that the filter assumes of the sensor. By the
/// radar, or, in a step without its value, by the LiDAR. Not valid in the step that starts a track,
/// and in one without any value.
class Witness {
 public:
  explicit Witness(const FusionSection& section);

  StatedRange Prediction(const track_t& track, const radar_t& radar, const lidar_t& lidar) const;

 private:
  double radar_variance_m2_;
  double lidar_variance_m2_;
};

}  // namespace fogline
