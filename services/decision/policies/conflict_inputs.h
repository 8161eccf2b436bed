// Converts the messages of a step into evidence of conflict, and the scenario into parameters of
// the conflict measures.
#pragma once

#include <cstddef>

#include "scenario/sections/scenario.h"
#include "services/decision/conflict/conflict_measures.h"
#include "services/graph.h"

namespace fogline::policies {

/// The parameters of the conflict measures. Some parameters are fields of `section` (section
/// `arbitrator` of the scenario, with its `transfer`). All other parameters have the defaults of
/// services/decision/conflict/conflict_parameters.h.
conflict::ConflictParameters ConflictParametersOf(const ArbitratorSection& section);

/// The table row of the measure that the scenario has chosen: a measure of conflict, or a measure
/// of blame.
const conflict::ConflictMeasureRow& RowOf(MeasureChoice choice);
const conflict::BlameMeasureRow& RowOf(BlameChoice choice);

/// Range and standard deviation as the sensor states them.
inline conflict::StatedRange StatedBy(const radar_t& radar) {
  return {.valid = radar.valid != 0, .range_m = radar.range_m, .std_m = radar.range_std_m};
}
inline conflict::StatedRange StatedBy(const lidar_t& lidar) {
  return {.valid = lidar.valid != 0, .range_m = lidar.range_m, .std_m = lidar.range_std_m};
}

/// Computes the range that the filter predicted before it used the values of the step. The
/// predicted range is the measured value minus the innovation. The variance of the prediction is
/// the innovation's variance minus the sensor noise that the filter assumes. The prediction is
/// computed from the radar's value, or from the LiDAR's value in a step without radar value. The
/// prediction is not valid in the step that starts a track, and in a step without any value.
///
/// If the filter estimates the noise itself (fusion.adaptive_noise), TRACK does not contain the
/// noise that the filter has used. The variance of the prediction is then computed from the
/// covariance of the previous step, as in the filter. So if the track of the previous step is
/// missing, there is no prediction.
class Witness {
 public:
  explicit Witness(const Scenario& scenario);

  /// The predicted range with its standard deviation. Call this function in the order of steps;
  /// steps may be missing.
  conflict::StatedRange Prediction(const track_t& track, const radar_t& radar,
                                   const lidar_t& lidar);

 private:
  /// The constants that are needed to compute the prediction from a sensor's range and its
  /// innovation.
  struct Sensor {
    std::size_t value;  // index in track_t's arrays
    double noise_m2;    // variance of the noise that the filter assumes
    double lateral_offset_m;
  };

  conflict::StatedRange Predicted(const track_t& track, const Sensor& sensor,
                                  double measured_m) const;
  /// Variance in m2 of a prediction of this range; 0 if it is not known.
  double VarianceOf(const track_t& track, const Sensor& sensor, double range_m) const;

  Sensor radar_;
  Sensor lidar_;
  bool adapts_;
  double step_s_;
  double jerk_density_m2ps5_;
  track_t last_{};  // the last track, if the filter estimates the noise
};

}  // namespace fogline::policies
