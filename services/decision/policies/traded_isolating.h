// Policy `traded_isolating`: traded control in which the automation does not use a sensor that is
// wrong.
#pragma once

#include "services/decision/policies/isolation.h"

namespace fogline::policies {

/// Decides by the paper's rule, like policy Traded. While the automation drives, it does not use
/// the sensor that is to blame, as in policy Isolate. If the driver must be asked, the automation
/// drives in this way until the driver takes over.
class TradedIsolating final : public EngagementPolicy {
 public:
  static constexpr Rule kRule = Rule::kThreshold;

  explicit TradedIsolating(const Scenario& scenario) : isolation_(scenario.arbitrator) {}

  SensorSelection SelectSensors(const FusionView& view) override {
    return isolation_.Judge(view.evidence);
  }
  EngagementRequest Decide(const ArbitratorView& view) override {
    return Compare(view.doc, view.threshold);
  }

 private:
  Isolation isolation_;
};

}  // namespace fogline::policies
