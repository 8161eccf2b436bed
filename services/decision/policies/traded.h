// Policy `traded`: the traded control of the paper.
#pragma once

#include "services/decision/policies/policy.h"

namespace fogline::policies {

/// The automation drives (lambda_A = 1) if 0 <= DoC < DoC_th, else the human drives (Sourav & Cheng
/// 2024). DoC_th is the scenario's threshold.
class Traded final : public EngagementPolicy {
 public:
  static constexpr Rule kRule = Rule::kThreshold;

  explicit Traded(const Scenario&) {}

  EngagementRequest Decide(const ArbitratorView& view) override {
    return Compare(view.doc, view.threshold);
  }
};

}  // namespace fogline::policies
