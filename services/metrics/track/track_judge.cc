#include "services/metrics/track/track_judge.h"

#include <algorithm>

namespace fogline::metrics {

double ErrorOfOffsets(const Scenario& scenario) {
  const FusionSection& fusion = scenario.fusion;
  const double radar = 1 / (fusion.radar_range_std_m * fusion.radar_range_std_m);
  const double lidar = 1 / (fusion.lidar_range_std_m * fusion.lidar_range_std_m);
  return (radar * scenario.radar.bias_m + lidar * scenario.lidar.bias_m) / (radar + lidar);
}

TrackJudge::TrackJudge(const Scenario& scenario) {
  const double offset_m = ErrorOfOffsets(scenario);
  const double tolerance_m = scenario.measures.lidar_tolerance_m;
  least_error_m_ = std::min(0.0, offset_m) - tolerance_m;
  most_error_m_ = std::max(0.0, offset_m) + tolerance_m;
}

// Without a track the error is NaN, and both comparisons are false. So the result is false.
bool TrackJudge::IsWrong(const Sample& sample) const {
  const double error_m = sample.fused_distance_m - sample.host_gap_m;
  return error_m < least_error_m_ || error_m > most_error_m_;
}

}  // namespace fogline::metrics
