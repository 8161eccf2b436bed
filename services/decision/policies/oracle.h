// Policy `oracle`: the best possible selection of radar or LiDAR. The policy uses the true gap for
// this selection. No car knows the true gap.
#pragma once

#include <cmath>

#include "services/decision/policies/policy.h"

namespace fogline::policies {

/// Uses the true gap to select the better sensor, as in the fusion-fault test of Zhong et al.
/// (FusED, ISSTA 2022). If both sensors have a value, the fusion uses only the value nearer to the
/// true gap. If both values are equally near, the fusion uses the radar's value. The automation
/// always drives.
class Oracle final : public EngagementPolicy {
 public:
  static constexpr bool kNeedsTrueGap = true;
  static constexpr Rule kRule = Rule::kNever;

  explicit Oracle(const Scenario&) {}

  SensorSelection SelectSensors(const FusionView& view) override {
    const auto& [radar, lidar, prediction] = view.evidence;
    if (!view.true_gap_m || !radar.valid || !lidar.valid) return {};
    const bool best_is_radar =
        std::abs(radar.range_m - *view.true_gap_m) <= std::abs(lidar.range_m - *view.true_gap_m);
    return {.radar = best_is_radar, .lidar = !best_is_radar};
  }
  EngagementRequest Decide(const ArbitratorView& view) override {
    return StayAutomated(view.threshold);
  }
};

}  // namespace fogline::policies
