#include "services/decision/policies/conflict_inputs.h"

#include <cmath>
#include <cstddef>

namespace fogline::policies {
namespace {

// Indices of the ranges in track_t's arrays.
constexpr std::size_t kRadarRange = 0;
constexpr std::size_t kLidarRange = 2;

conflict::StatedRange Predicted(const track_t& track, std::size_t value, double measured_m,
                                double noise_m2) {
  if (track.usage[value] == track_t::ABSENT) return {};
  const double variance_m2 = track.innovation_variance[value] - noise_m2;
  if (variance_m2 <= 0) return {};  // the value started the track
  return {.valid = true,
          .range_m = measured_m - track.innovation[value],
          .std_m = std::sqrt(variance_m2)};
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

Witness::Witness(const FusionSection& section)
    : radar_variance_m2_(section.radar_range_std_m * section.radar_range_std_m),
      lidar_variance_m2_(section.lidar_range_std_m * section.lidar_range_std_m) {}

conflict::StatedRange Witness::Prediction(const track_t& track, const radar_t& radar,
                                          const lidar_t& lidar) const {
  if (radar.valid) return Predicted(track, kRadarRange, radar.range_m, radar_variance_m2_);
  if (lidar.valid) return Predicted(track, kLidarRange, lidar.range_m, lidar_variance_m2_);
  return {};
}

}  // namespace fogline::policies
