// Policy `isolate`: the automation drives without the sensor that is to blame. The policy is a
// reference for hand-overs: they are useful only if their result is better than the result of
// `isolate`.
#pragma once

#include "services/decision/policies/isolation.h"

namespace fogline::policies {

/// Fault isolation: the fusion continues without the sensor that is to blame, and the human never
/// drives.
class Isolate final : public EngagementPolicy {
 public:
  static constexpr Rule kRule = Rule::kNever;

  explicit Isolate(const Scenario& scenario) : isolation_(scenario.arbitrator) {}

  SensorSelection SelectSensors(const FusionView& view) override {
    return isolation_.Judge(view.evidence);
  }
  EngagementRequest Decide(const ArbitratorView& view) override {
    return StayAutomated(view.threshold);
  }

 private:
  Isolation isolation_;
};

}  // namespace fogline::policies
