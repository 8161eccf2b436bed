// Policy `none`: the baseline with which other policies are compared.
#pragma once

#include "services/decision/policies/policy.h"

namespace fogline::policies {

/// The automation drives in every step (lambda_A = 1).
class None final : public EngagementPolicy {
 public:
  static constexpr Rule kRule = Rule::kNever;

  explicit None(const Scenario&) {}

  EngagementRequest Decide(const ArbitratorView& view) override {
    return StayAutomated(view.threshold);
  }
};

}  // namespace fogline::policies
