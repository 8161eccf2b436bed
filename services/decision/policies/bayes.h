// Policy `bayes`: traded control that chooses the smaller expected cost.
#pragma once

#include <algorithm>

#include "services/decision/policies/policy.h"

namespace fogline::policies {

/// The human drives while P C_a >= (1 - P) C_h, with the expected costs C_a and C_h below. This
/// condition is equivalent to P >= C_h/(C_h + C_a), so C_h/(C_h + C_a) is the threshold of the
/// step. P is the probability that the automation is deceived; the policy uses the DoC as P. With
/// measure lidar_modes and measure_scale probability, the DoC is a probability
/// (services/decision/conflict/over_time/lidar_modes.h). With the paper's conflict z, the DoC is
/// only a steep function of z. The expected costs depend on the driver's readiness A, the
/// visibility MOR and the follower's time to collision TTC. All other words in the equations are
/// fields of the scenario (BayesSection). The endings _cost and _s of these fields are left out:
/// `human` stands for human_cost, for example.
///
///     C_h = human + unready (1 - A) + blind min(1, near_m/MOR)      of a human who drives
///     C_a = automation + follower min(1, near_ttc/TTC)              of a deceived automation
///
/// The rule is Bayes' decision between two actions (Berger 1985, 4.4); the costs are our choice.
class Bayes final : public EngagementPolicy {
 public:
  static constexpr bool kNeedsSurroundings = true;
  static constexpr bool kUsesThreshold = false;

  explicit Bayes(const Scenario& scenario) : section_(scenario.arbitrator.bayes) {}

  EngagementRequest Decide(const ArbitratorView& view) override {
    const Surroundings& around = view.surroundings;
    const double blindness = std::min(1.0, section_.near_m / around.visibility_m);
    const double closeness =
        std::min(1.0, section_.near_ttc_s * around.ClosingRate(view.ego.speed_mps));
    const double human = section_.human_cost + section_.unready_cost * (1 - view.driver.readiness) +
                         section_.blind_cost * blindness;
    const double automation = section_.automation_cost + section_.follower_cost * closeness;
    return Compare(view.doc, human / (human + automation));
  }

 private:
  BayesSection section_;
};

}  // namespace fogline::policies
