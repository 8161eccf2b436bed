// Real time: the world ticks on the wall clock and does not wait for any role. A role that lacks an
// input does not ask for it, because the input would be too old when it came. As soon as a newer
// step is complete, the role leaves the incomplete step out and counts it. After a pause of its own
// a role computes every complete step, in order, because a filter and the log need them all. A
// message that comes after the end of its step is late: it is counted and never used. A role does
// not wait for an input on demand and does not judge it.
//
// A message of a step that cannot be under way is refused. The progress that the runner reports
// always limits the steps. The steps that were heard limit them, too, unless no new step was heard
// for some periods. So a role that is wrong about the progress corrects itself soon (for example a
// role that was started in the middle of the run and heard an old message first). One false message
// can mislead a role by the slack of two steps. Many false messages can mislead it by no more than
// the runner's report allows, which is one second.
//
// The rule also judges every input by age (input_health.h). STATUS reports the state of each input,
// the culprit, and how well the role keeps its time. A change of a state is reported at once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/runtime/lockstep/fire_rule.h"
#include "services/runtime/realtime/input_health.h"
#include "services/runtime/realtime/realtime_statistics.h"
#include "services/runtime/realtime/run_clock.h"
#include "services/runtime/realtime/step_horizon.h"

namespace fogline::runtime {

/// How long a step takes on the wall clock.
/// @pre IsSpeed(speed)
Duration PeriodOf(const Scenario& scenario, double speed);

class RealtimeRule : public FireRule {
 public:
  /// @param speed simulated seconds per second. @pre IsSpeed(speed)
  RealtimeRule(Node& node, const Scenario& scenario, double speed);

  StepRing::Verdict Classify(std::size_t input, std::int64_t step, Bytes bytes) override;
  void OnInput(std::size_t input, std::int64_t step, TimePoint time) override;
  TimePoint Poll(TimePoint now) override;
  void OnProgress() override;
  void WriteStatus(TimePoint now) override;

  InputState StateOf(std::size_t input) const { return health_[input].state(); }
  /// The state of an input for an algorithm that computes a step without some of its inputs. The
  /// world's tick of this step counts as OK if it is there, however long it was silent before.
  InputState StateFor(std::size_t input, std::int64_t step) const {
    return input == tick_input_ && inputs()[input].ring.Has(step) ? InputState::kOk
                                                                  : StateOf(input);
  }

 protected:
  /// Computes the steps that are due, if any. @return the latest time for the next call
  virtual TimePoint Fire(TimePoint now);

  /// The first step up to `newest` that may still be computed.
  std::int64_t Oldest(std::int64_t newest) const {
    return std::max(next(), newest - kRingSteps + 1);
  }
  /// Computes a step that was due at `due`. Steps between the last one and this one are counted as
  /// missed.
  void ComputeDue(std::int64_t step, TimePoint due, TimePoint now);
  /// The inputs that a step needs. The inputs on demand stand behind them in inputs().
  std::span<const Input> awaited() const { return std::span(inputs()).first(health_.size()); }
  /// Whether a message of the input has come lately, in time or too late to be used.
  bool Speaks(std::size_t input, TimePoint now) const {
    return now - std::max(late_at_[input], inputs()[input].heard) <= kSpeaks * period_;
  }

  Duration period() const { return period_; }
  /// Newest step that is known to be under way, -1 if none.
  std::int64_t newest() const { return newest_; }
  /// Newest step that can be under way.
  std::int64_t NewestPossible(TimePoint now) const;
  /// Notes that this step is under way, as the runner's progress or a message of the step shows.
  void KnowOf(std::int64_t step) { newest_ = std::max(newest_, step); }
  void Begun(std::int64_t step, TimePoint now);
  RealtimeStatistics& statistics() { return statistics_; }
  /// The input that brings the world's ticks; inputs().size() if there is none.
  std::size_t tick_input() const { return tick_input_; }

 private:
  /// The longest interval, in periods, between two steps of an input that comes again. An input
  /// that is lost has by default been silent for longer.
  static constexpr int kSpeaks = 2;
  /// After this many periods without a newer step, the runner's progress counts, too.
  static constexpr int kUnheard = 3;

  /// Counts a message that is too late to be used.
  void CountLate(std::size_t input);
  /// Takes the time into account. @return when the passage of time may next change a state
  TimePoint UpdateHealth(TimePoint now);
  /// The clock that judges an input. The world's ticks are judged on the wall clock without this
  /// process's own pauses, in which it could not hear them. All other inputs are judged on the
  /// clock of the run.
  TimePoint ClockOf(std::size_t input, TimePoint now) const {
    return input == tick_input_ && clock_.started() ? now - paused_ : clock_.At(now);
  }
  /// Notices a pause of this process: a call that comes much later than it was asked for.
  void NoticeOwnPause(TimePoint now);
  void NameCulprit(TimePoint now);

  /// The part of a period by which a call may be late, as for the world's ticks (RunClock).
  static constexpr double kGrace = 0.25;

  Duration period_;
  TimePoint wake_ = TimePoint::max();  // the latest time for which the next call was asked
  Duration paused_{};                  // sum of this process's pauses
  std::int64_t step_us_;
  HealthSection limits_;
  RunClock clock_;
  StepHorizon heard_;  // by the steps that were heard
  StepHorizon told_;   // by the runner's progress
  std::size_t tick_input_;
  std::vector<InputHealth> health_;  // one for each awaited input
  std::vector<std::int64_t> late_;
  std::vector<TimePoint> late_at_;  // when the last late message came
  RealtimeStatistics statistics_;
  std::int64_t newest_ = -1;
  std::string fallback_;  // in the last STATUS
};

}  // namespace fogline::runtime
