// Decides when a role computes a step in real time. The world ticks on the wall clock and does not
// wait for any role. A step is complete if the role has all inputs of this step. A role that lacks
// an input does not ask for it, because the input would come too late. As soon as a newer step is
// complete, the role leaves the incomplete step out and counts it as missed. After a pause of its
// own process, the role computes every complete step, in order. The log needs all these steps. A
// role that filters its inputs over time needs them, too. A role does not wait for an input that it
// reads only in some scenarios (an input on demand).
//
// Most roles use this class. The world (tick_rule.h), the arbitrator (deadline_rule.h) and the
// recorder (record_rule.h) have other classes for this decision.
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
  /// Computes every step for which the role has all inputs. @return the latest time for the next
  /// call
  TimePoint Fire(TimePoint now);

  Parts& parts_;
  RealtimeWatch watch_;
};

}  // namespace fogline::runtime
