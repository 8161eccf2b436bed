// Policy `traded`: the traded control of the paper.
#pragma once

#include "services/decision/policies/policy.h"

namespace fogline::policies {

/// lambda_A = 1 if 0 <= DoC < DoC_th, else 0 (Sourav & Cheng 2024).
class Traded final : public EngagementPolicy {
 public:
  static constexpr Rule kRule = Rule::kThreshold;

  explicit Traded(const Scenario&) {}

  EngagementRequest Decide(const ArbitratorView& view) override {
    return Compare(view.doc, view.threshold);
  }
};

}  // namespace fogline::policies
