// The rule in real time. The world ticks on the wall clock and does not wait for any role. A role
// that lacks an input does not ask for it, because the input would come too late. As soon as a
// newer step is complete, the role leaves the incomplete step out and counts it. If the role's own
// process was paused, the role then computes every complete step, in order. The log needs all these
// steps, and so does a role that filters its inputs over time. A role does not wait for an input on
// demand.
//
// This is the rule of most roles. The world (tick_rule.h), the arbitrator (deadline_rule.h) and the
// recorder have other rules.
#pragma once

#include "services/runtime/node/fire_rule.h"
#include "services/runtime/realtime/realtime_watch.h"

namespace fogline::runtime {

class RealtimeRule final : public FireRule {
 public:
  RealtimeRule(Parts& parts, const Scenario& scenario) : parts_(parts), watch_(parts, scenario) {}

  void OnInput(std::size_t input, std::int64_t step, Arrival& arrival) override;
  TimePoint Poll(TimePoint now) override;
  void OnProgress() override { watch_.OnProgress(); }
  void WriteStatus(TimePoint now) override { watch_.WriteStatus(now); }

 private:
  /// Computes every complete step. @return the latest time for the next call
  TimePoint Fire(TimePoint now);

  Parts& parts_;
  RealtimeWatch watch_;
};

}  // namespace fogline::runtime
