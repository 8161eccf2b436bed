// Policy `oracle`: what isolation could do at best. No car can have it.
#pragma once

#include <cmath>

#include "services/policies/policy.h"

namespace fogline {

/// The best sensor by truth, as in the fusion-fault test of Zhong et al. (FusED, ISSTA 2022): of
/// two values the fusion uses the one that is nearer to the true gap, the radar's if they are
/// equally near. The automation drives throughout.
class Oracle final : public EngagementPolicy {
 public:
  static constexpr bool kNeedsTrueGap = true;
  static constexpr Rule kRule = Rule::kNever;

  explicit Oracle(const Scenario&) {}

  Trust TrustIn(const FusionView& view) override {
    const auto& [radar, lidar, prediction] = view.evidence;
    if (!view.true_gap_m || !radar.valid || !lidar.valid) return {};
    const bool best_is_radar =
        std::abs(radar.range_m - *view.true_gap_m) <= std::abs(lidar.range_m - *view.true_gap_m);
    return {.radar = best_is_radar, .lidar = !best_is_radar};
  }
  Wish Decide(const ArbitratorView& view) override { return StayAutomated(view.threshold); }
};

}  // namespace fogline
