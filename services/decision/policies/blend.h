// Policy `blend`: shared control, the alternative to traded control.
#pragma once

#include <algorithm>

#include "services/decision/policies/policy.h"

namespace fogline::policies {

/// The human's authority is lambda_H = clip((DoC - from)/width, 0, 1). Both sides drive, and the
/// human's share grows with the conflict. `from` and `width` are fields of BlendSection. The
/// reported threshold is the DoC at which the human has half of the authority, but at most 1.
class Blend final : public EngagementPolicy {
 public:
  static constexpr bool kShares = true;
  static constexpr bool kUsesThreshold = false;

  explicit Blend(const Scenario& scenario) : section_(scenario.arbitrator.blend) {}

  EngagementRequest Decide(const ArbitratorView& view) override {
    return {.lambda_human = std::clamp((view.doc - section_.from) / section_.width, 0.0, 1.0),
            .threshold = std::min(1.0, section_.from + section_.width / 2),
            .firm = true};
  }

 private:
  BlendSection section_;
};

}  // namespace fogline::policies
