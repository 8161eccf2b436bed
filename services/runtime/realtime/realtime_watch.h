// The common part of the classes that implement FireRule (fire_rule.h) in real time. This part
// decides which messages are in time, judges inputs by age (input_health.h), computes a step that
// is due, and keeps the statistics of the role.
//
// A message that comes after the end of its step is late: it is counted and never used. A message
// of a step that the run cannot have reached is refused (step_horizon.h). An input that the role
// reads only in some scenarios (an input on demand, services/algorithm.h) is not judged and has no
// state.
//
// STATUS reports the state of each input, the input that is to blame if inputs are missing
// (culprit.h), and how punctual the role is. When a state changes, a STATUS is sent immediately.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/runtime/node/parts.h"
#include "services/runtime/realtime/input_health.h"
#include "services/runtime/realtime/realtime_statistics.h"
#include "services/runtime/realtime/run_clock.h"
#include "services/runtime/realtime/step_horizon.h"

namespace fogline::runtime {

/// How long a step takes on the wall clock.
/// @pre IsSpeed(speed)
Duration PeriodOf(const Scenario& scenario, double speed);

class RealtimeWatch {
 public:
  /// @pre IsSpeed(parts.run.pace)
  RealtimeWatch(Parts& parts, const Scenario& scenario);

  /// Decides what to do with an input's message of a step, and counts the message if it is late.
  StepRing::Verdict Judge(std::size_t input, std::int64_t step, Bytes bytes);
  /// Notes that Inputs::Keep() has stored a new message of an input.
  void Heard(std::size_t input, std::int64_t step, TimePoint time);
  /// Handles a message of an input: calls Judge(), Inputs::Keep() and, if the message was stored,
  /// Heard(). A FireRule that does more between these calls does not use Take().
  void Take(std::size_t input, std::int64_t step, Arrival& arrival) {
    const auto verdict = Judge(input, step, arrival.bytes());
    if (parts_.inputs.Keep(input, step, arrival, verdict)) Heard(input, step, arrival.time());
  }
  /// Reads the waiting messages and judges the inputs. Then, if the role still runs, calls `fire`.
  /// @param fire computes the steps that are due, and returns the latest time for its next call
  /// @return the latest time for the next call of Poll()
  TimePoint Poll(TimePoint now, const std::function<TimePoint(TimePoint now)>& fire);
  /// Notes the progress that a RUN has reported.
  void OnProgress() { horizon_.Told(parts_.run.progress, Clock::now()); }
  /// Writes the states of the inputs and the statistics into STATUS.
  void WriteStatus(TimePoint now);

  InputState StateOf(std::size_t input) const { return health_[input].state(); }
  /// The state of an input, for an algorithm that can compute a step although some inputs are
  /// missing. The input that brings the world's ticks counts as OK if the tick of this step has
  /// come, even if no tick came for a long time before.
  InputState StateFor(std::size_t input, std::int64_t step) const;
  /// Whether a message of the input has come recently, either in time or too late to be used.
  bool Speaks(std::size_t input, TimePoint now) const;

  /// The inputs without which a step is incomplete. These are all inputs that the role reads in
  /// every scenario (Input::on_demand is false).
  std::span<const Input> awaited() const { return parts_.inputs.all().first(health_.size()); }
  /// The index of the input that brings the world's ticks, which begin the steps. If the role has
  /// no such input, the result is the number of inputs.
  std::size_t tick_input() const { return tick_input_; }
  /// The oldest step that may still be computed when `newest` is the newest step. Older steps are
  /// before the role's next step, or the rings of the inputs do not store them any more.
  std::int64_t Oldest(std::int64_t newest) const {
    return std::max(parts_.steps.next(), newest - kRingSteps + 1);
  }
  /// Computes a step that was due at `due`. The steps between the last computed step and this step
  /// are counted as missed.
  void ComputeDue(std::int64_t step, TimePoint due, TimePoint now);

  /// Notes that the world has begun this step now.
  void Begun(std::int64_t step, TimePoint now);
  RunHorizon& horizon() { return horizon_; }
  /// The newest step that the run can have reached.
  std::int64_t NewestPossible(TimePoint now) const {
    return horizon_.NewestPossible(now, clock_.Silence(now));
  }
  RealtimeStatistics& statistics() { return statistics_; }

 private:
  /// Messages of an input that were too late to be used.
  struct Late {
    std::int64_t count = 0;
    TimePoint at{};  // when the last message came
  };
  /// The pauses of this process. The process was paused if Poll() was called much later than
  /// `wake`.
  struct OwnPause {
    TimePoint wake = TimePoint::max();  // the result of the last Poll()
    Duration sum{};
  };

  void NoticeOwnPause(TimePoint now);
  /// Updates the states to the time `now`. @return the next time at which a state may change
  /// without a new message
  TimePoint UpdateHealth(TimePoint now);
  /// The time `now` on the clock by which an input is judged. The world's ticks are judged by the
  /// wall clock without the pauses of this process, because the process receives no ticks during a
  /// pause. All other inputs are judged by the clock of the run (RunClock).
  TimePoint ClockOf(std::size_t input, TimePoint now) const {
    return input == tick_input_ && clock_.started() ? now - pause_.sum : clock_.At(now);
  }
  void NameCulprit(TimePoint now);

  Parts& parts_;
  Duration period_;
  std::int64_t step_us_;
  HealthSection limits_;
  OwnPause pause_;
  RunClock clock_;
  RunHorizon horizon_;
  std::size_t tick_input_;
  std::vector<InputHealth> health_;  // one for each awaited input
  std::vector<Late> late_;           // one for each input
  RealtimeStatistics statistics_;
  std::string fallback_;  // the fallback in the last STATUS
};

}  // namespace fogline::runtime
