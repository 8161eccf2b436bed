// services/decision/policies/cautious.h: traded control that also asks how sure the fusion is.
#pragma once

#include "services/decision/policies/policy.h"

namespace fogline::policies {

/// Traded control. In addition, the human drives at any DoC while there is no track, or while the
/// track's distance has a standard deviation above 2 m.
class Cautious final : public EngagementPolicy {
 public:
  explicit Cautious(const Scenario&) {}

  EngagementRequest Decide(const ArbitratorView& view) override {
    constexpr double kMaxVariance_m2 = 4;
    const bool lost = !view.track.valid || view.track.covariance[0][0] > kMaxVariance_m2;
    return Compare(view.doc, lost ? 0 : view.threshold);
  }
};

}  // namespace fogline::policies
