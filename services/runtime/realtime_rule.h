// Real time: the world ticks on the wall clock and waits for nobody, so a role that lacks an input
// does not ask for it (by the time it came it would be old) but leaves the step out, and counts it,
// as soon as a newer one is complete. When it was held up itself it computes every step that is
// complete, in order: a filter needs them all, and so does the log. What comes after its step is
// over is late: it is counted and never used. An input that is read on demand is neither waited for
// nor judged.
//
// What is of a step that cannot be under way is refused: unless nothing new has been heard for some
// periods, by what was heard of the steps themselves; and always by what the runner says of the
// progress. So a role that is wrong about how far the run is (it was started in the middle of it,
// and heard an old message first) is right again soon. A false message can make it wrong by the
// slack of two steps, and many of them by no more than what the runner's word lets pass, a second.
//
// It also judges every input by age (input_health.h), says in STATUS how each is, who is to blame,
// and how well it keeps its time, and says it at once when that changes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "services/runtime/fire_rule.h"
#include "services/runtime/input_health.h"
#include "services/runtime/realtime_statistics.h"
#include "services/runtime/run_clock.h"
#include "services/runtime/step_horizon.h"

namespace fogline {

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
  /// world's tick of this very step cannot be lost, however long it was before.
  InputState StateFor(std::size_t input, std::int64_t step) const {
    return input == tick_input_ && inputs()[input].ring.Has(step) ? InputState::kOk
                                                                  : StateOf(input);
  }

 protected:
  /// Computes the steps whose time has come, if any. @return when to be called again at the latest
  virtual TimePoint Fire(TimePoint now);

  /// The first step up to `newest` that may be computed still.
  std::int64_t Oldest(std::int64_t newest) const {
    return std::max(next(), newest - kRingSteps + 1);
  }
  /// Computes a step that was due then; steps between the last one and it are missed.
  void ComputeDue(std::int64_t step, TimePoint due, TimePoint now);
  /// The inputs that a step is made of; what is read on demand stands behind them.
  std::span<const Input> awaited() const { return std::span(inputs()).first(health_.size()); }
  /// Something of the input has come lately, in time or too late to be used.
  bool Speaks(std::size_t input, TimePoint now) const {
    return now - std::max(late_at_[input], inputs()[input].heard) <= kSpeaks * period_;
  }

  Duration period() const { return period_; }
  /// Newest step that is known to be under way, -1 if none.
  std::int64_t newest() const { return newest_; }
  /// Newest step that can be under way.
  std::int64_t NewestPossible(TimePoint now) const;
  /// This step is under way: as the runner says, or as a message of it tells just now.
  void KnowOf(std::int64_t step) { newest_ = std::max(newest_, step); }
  void Begun(std::int64_t step, TimePoint now);
  RealtimeStatistics& statistics() { return statistics_; }
  /// The input that brings the world's ticks; inputs().size() if there is none.
  std::size_t tick_input() const { return tick_input_; }

 private:
  /// Periods between two steps of an input that comes again; an input that is lost by default has
  /// been silent for longer.
  static constexpr int kSpeaks = 2;
  /// Periods without a newer step after which the runner knows better how far the run is.
  static constexpr int kUnheard = 3;

  /// A message that is too late to be used.
  void CountLate(std::size_t input);
  /// Takes the time into account. @return when that may change a state
  TimePoint UpdateHealth(TimePoint now);
  /// The world's ticks are judged on the wall clock without this process's own pauses, in which it
  /// could not hear them; everything else on the clock of the run.
  TimePoint ClockOf(std::size_t input, TimePoint now) const {
    return input == tick_input_ && clock_.started() ? now - paused_ : clock_.At(now);
  }
  /// Notices that it was called much later than it had asked for.
  void NoticeOwnPause(TimePoint now);
  void NameCulprit(TimePoint now);

  /// Part of a period by which a call may be late: as the world's ticks (RunClock).
  static constexpr double kGrace = 0.25;

  Duration period_;
  TimePoint wake_ = TimePoint::max();  // when the next call was asked for, at the latest
  Duration paused_{};                  // of this process, in all
  std::int64_t step_us_;
  HealthSection limits_;
  RunClock clock_;
  StepHorizon heard_;  // by what was heard of the steps
  StepHorizon told_;   // by what the runner says
  std::size_t tick_input_;
  std::vector<InputHealth> health_;  // of the awaited inputs
  std::vector<std::int64_t> late_;
  std::vector<TimePoint> late_at_;  // the last one
  RealtimeStatistics statistics_;
  std::int64_t newest_ = -1;
  std::string fallback_;  // as last published
};

}  // namespace fogline
