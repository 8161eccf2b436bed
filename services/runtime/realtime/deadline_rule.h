// The rule (fire_rule.h) that decides in real time when the arbitrator computes a step. The
// arbitrator is the role that must decide in every step. It decides as soon as it has all inputs
// that are not lost. It also waits for a lost input if messages of this input come again. At its
// deadline, a fixed time after the world's tick, it decides with the inputs that it has. The
// deadline is so early that the command still reaches the world in time. If the next step has
// already begun, the arbitrator decides immediately.
#pragma once

#include "services/runtime/node/fire_rule.h"
#include "services/runtime/realtime/realtime_watch.h"

namespace fogline::runtime {

class DeadlineRule final : public FireRule {
 public:
  DeadlineRule(Parts& parts, const Scenario& scenario);

  void OnInput(std::size_t input, std::int64_t step, Arrival& arrival) override;
  TimePoint Poll(TimePoint now) override;
  void OnProgress() override { watch_.OnProgress(); }
  void WriteStatus(TimePoint now) override { watch_.WriteStatus(now); }

  const RealtimeWatch& watch() const { return watch_; }

 private:
  /// Decides the steps that are due. @return the latest time for the next call
  TimePoint Fire(TimePoint now);
  /// Decides a step immediately, with the inputs that have come.
  void Decide(std::int64_t step, TimePoint now);

  Parts& parts_;
  RealtimeWatch watch_;
  Duration until_deadline_;  // time from the tick to the deadline
};

}  // namespace fogline::runtime
