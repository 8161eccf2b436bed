// Real time for the role that must decide in every step (the arbitrator): it does so as soon as all
// inputs are there that are not lost (or that come again), and at the latest so long after the
// world's tick that the decision can still be on time; then with what there is. A step whose
// successor has begun is decided at once.
#pragma once

#include <optional>

#include "services/runtime/realtime_rule.h"

namespace fogline {

class DeadlineRule final : public RealtimeRule {
 public:
  DeadlineRule(Node& node, const Scenario& scenario, double speed);

 private:
  TimePoint Fire(TimePoint now) override;
  /// Decides with what there is.
  void Decide(std::int64_t step, TimePoint now);

  Duration patience_;  // from the tick to the deadline
};

}  // namespace fogline
