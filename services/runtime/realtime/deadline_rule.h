// The real-time rule for the role that must decide in every step (the arbitrator). It decides as
// soon as it has all inputs that are not lost. It also waits for a lost input that comes again. At
// a fixed time after the world's tick it decides with the inputs that it has. This time is early
// enough for the command to reach the world in time. If the next step has already begun, it decides
// at once.
#pragma once

#include <optional>

#include "services/runtime/realtime/realtime_rule.h"

namespace fogline::runtime {

class DeadlineRule final : public RealtimeRule {
 public:
  DeadlineRule(Node& node, const Scenario& scenario, double speed);

 private:
  TimePoint Fire(TimePoint now) override;
  /// Decides with the inputs that are there.
  void Decide(std::int64_t step, TimePoint now);

  Duration until_deadline_;  // from the tick to the deadline
};

}  // namespace fogline::runtime
