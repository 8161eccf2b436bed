#include "services/decision/policies/conflict_inputs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace fogline::policies {
namespace {

// Indices of the ranges in track_t's arrays.
constexpr std::size_t kRadarRange = 0;
constexpr std::size_t kLidarRange = 2;

double Square(double x) { return x * x; }

// Variance in m2 of the distance that the filter predicts for the next step, computed from the
// filter's covariance P. The variance is element (0, 0) of F P F' + Q (services/fusion/ekf.h).
double NextDistanceVariance(const double (&covariance)[3][3], double step_s,
                            double jerk_density_m2ps5) {
  const std::array<double, 3> row{1, step_s, step_s * step_s / 2};  // of F
  double variance_m2 = jerk_density_m2ps5 * Square(step_s * step_s) * step_s / 20;
  for (std::size_t i = 0; i < row.size(); ++i) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      variance_m2 += row[i] * covariance[i][j] * row[j];
    }
  }
  return variance_m2;
}

}  // namespace

conflict::ConflictParameters ConflictParametersOf(const ArbitratorSection& section) {
  conflict::ConflictParameters parameters;
  parameters.offset_m = section.measure_offset_m;
  parameters.missing = section.missing_lidar;
  parameters.missing_conflict_m = section.missing_conflict_m;
  parameters.doc_slope_pm = section.doc_slope_per_m;
  parameters.doc_centre_m = section.doc_centre_m;
  parameters.doc_reading = section.conflict;
  parameters.window_steps = static_cast<int>(section.window_steps);
  parameters.sprt_alpha = section.transfer.sprt_alpha;
  parameters.sprt_beta = section.transfer.sprt_beta;
  return parameters;
}

const conflict::ConflictMeasureRow& RowOf(MeasureChoice choice) {
  return conflict::ConflictMeasures()[static_cast<std::size_t>(choice)];
}

const conflict::BlameMeasureRow& RowOf(BlameChoice choice) {
  return conflict::BlameMeasures()[static_cast<std::size_t>(choice)];
}

Witness::Witness(const Scenario& scenario)
    : radar_{.value = kRadarRange,
             .noise_m2 = Square(scenario.fusion.radar_range_std_m),
             .lateral_offset_m = scenario.radar.lateral_offset_m},
      lidar_{.value = kLidarRange,
             .noise_m2 = Square(scenario.fusion.lidar_range_std_m),
             .lateral_offset_m = scenario.lidar.lateral_offset_m},
      adapts_(scenario.fusion.adaptive_noise != NoiseAdaptation::kNone),
      step_s_(scenario.step_s),
      jerk_density_m2ps5_(scenario.fusion.jerk_density_m2ps5) {}

conflict::StatedRange Witness::Prediction(const track_t& track, const radar_t& radar,
                                          const lidar_t& lidar) {
  conflict::StatedRange prediction;
  if (radar.valid) {
    prediction = Predicted(track, radar_, radar.range_m);
  } else if (lidar.valid) {
    prediction = Predicted(track, lidar_, lidar.range_m);
  }
  if (adapts_) last_ = track;
  return prediction;
}

conflict::StatedRange Witness::Predicted(const track_t& track, const Sensor& sensor,
                                         double measured_m) const {
  if (track.usage[sensor.value] == track_t::ABSENT) return {};
  const double range_m = measured_m - track.innovation[sensor.value];
  const double variance_m2 = VarianceOf(track, sensor, range_m);
  if (variance_m2 <= 0) return {};  // unknown, or the value started the track
  return {.valid = true, .range_m = range_m, .std_m = std::sqrt(variance_m2)};
}

double Witness::VarianceOf(const track_t& track, const Sensor& sensor, double range_m) const {
  if (!adapts_) return track.innovation_variance[sensor.value] - sensor.noise_m2;
  if (!last_.valid || last_.header.step + 1 != track.header.step) return 0;
  const double variance_m2 = NextDistanceVariance(last_.covariance, step_s_, jerk_density_m2ps5_);
  if (sensor.lateral_offset_m == 0) return variance_m2;
  // The range of a target at distance d and offset y is sqrt(d^2 + y^2). The derivative of this
  // range by d is d / range.
  return variance_m2 * std::max(0.0, 1 - Square(sensor.lateral_offset_m / range_m));
}

}  // namespace fogline::policies
