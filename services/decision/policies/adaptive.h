// Policy `adaptive`: traded control with a threshold that moves with the situation.
#pragma once

#include <algorithm>

#include "services/decision/policies/policy.h"

namespace fogline::policies {

/// The human drives if the DoC is at least this threshold of step k:
///
///     DoC_th(k) = clip(DoC_th + k_A (1 - A) - k_M/MOR - k_C/TTC - k_B max(0, -a), least, most)
///
/// with the driver's readiness A, the visibility MOR, the follower's time to collision TTC and the
/// host's acceleration a. The gains k_A, k_M, k_C, k_B and the limits least, most are fields of the
/// scenario (AdaptiveSection). DoC_th on the right side is the scenario's threshold. The threshold
/// is higher for a driver who is not ready. It is lower if the fog is dense, if the follower's TTC
/// is short, or if the host already brakes. The formula is our choice; the paper suggests a
/// threshold that moves with the situation (future work 3).
class Adaptive final : public EngagementPolicy {
 public:
  static constexpr bool kNeedsSurroundings = true;

  explicit Adaptive(const Scenario& scenario) : section_(scenario.arbitrator.adaptive) {}

  EngagementRequest Decide(const ArbitratorView& view) override {
    return Compare(view.doc, Threshold(view));
  }

 private:
  double Threshold(const ArbitratorView& view) const {
    const Surroundings& around = view.surroundings;
    const double threshold =
        view.threshold + section_.readiness_gain * (1 - view.driver.readiness) -
        section_.visibility_gain_m / around.visibility_m -
        section_.closing_gain_s * around.ClosingRate(view.ego.speed_mps) -
        section_.braking_gain_s2pm * std::max(0.0, -view.ego.acceleration_mps2);
    return std::clamp(threshold, section_.least, section_.most);
  }

  AdaptiveSection section_;
};

}  // namespace fogline::policies
