// The rule (fire_rule.h) that decides in real time when the world computes a step. The world is the
// role that begins the steps. It computes one step at each tick of the wall clock, even if roles
// have not answered.
//
// Step k is due k periods after the start, on a grid that does not drift. While the process or its
// machine is paused, ticks pass without a step. Only the last of these ticks begins a step. If the
// whole machine was paused, the other roles may not have finished the previous step. In this case
// the late tick waits up to 3 ms for these roles, and the next tick comes at least a quarter of a
// period after the late tick. Simulated time is counted in steps. So simulated time stops while the
// world's process is stopped, and no step is ever left out. Missed ticks are counted.
//
// A world that is started again continues after the last TRUTH that the recorder has.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "services/runtime/lockstep/step_gate.h"
#include "services/runtime/node/fire_rule.h"
#include "services/runtime/realtime/realtime_watch.h"

namespace fogline::runtime {

class TickRule final : public FireRule {
 public:
  /// A function that lets a restarted world continue after the step of `truth`. It computes the
  /// later steps that are known to have begun, but does not publish them.
  using TakeOver = std::function<void(const truth_t& truth)>;

  TickRule(Parts& parts, const Scenario& scenario, StepGate& gate, TakeOver take_over);

  void OnGo(const run_t& run, TimePoint now) override;
  void OnInput(std::size_t input, std::int64_t step, Arrival& arrival) override;
  TimePoint Poll(TimePoint now) override;
  void OnProgress() override { watch_.OnProgress(); }
  void SetFinal(std::int64_t step) override;
  void WriteStatus(TimePoint now) override;

  const RealtimeWatch& watch() const { return watch_; }

 private:
  enum class Phase { kWaiting, kResuming, kTicking, kEnding };

  /// Does what is due in this phase. @return the latest time for the next call
  TimePoint Fire(TimePoint now);
  TimePoint LookForTruth(TimePoint now);
  /// Asks the recorder for TRUTH, and the producers for the commands.
  void AskForTruth();
  /// The first of the steps that a restarted world asks for.
  std::int64_t FirstAsked() const;
  /// Whether the world can continue after this TRUTH.
  bool CanResume(const truth_t& truth) const;
  TimePoint Resume(TimePoint now);
  TimePoint Tick(TimePoint now);
  TimePoint End(TimePoint now);
  /// Measures the latency of a step's command, which may come in time or late. Each step counts
  /// once.
  void TakeLatency(std::size_t input, std::int64_t step, TimePoint time);
  /// Whether the commands for the next step have come, or this step needs no commands.
  bool Answered() const;
  /// When tick `n` of the grid is due.
  TimePoint Due(std::int64_t n) const;

  /// The ticks of the wall clock.
  struct Grid {
    Duration period;
    TimePoint start{};
    std::int64_t next = 0;    // next tick
    std::int64_t missed = 0;  // ticks at which no step was begun
  };
  /// A published step whose command has not come yet.
  struct Sent {
    std::int64_t step = -1;
    TimePoint time{};
  };
  /// The search of a restarted world for the last TRUTH.
  struct Search {
    bool listening = false;
    TimePoint ask_at{};
    std::optional<truth_t> newest;  // the newest TRUTH among the answers
    TimePoint answered_at{};        // when the first answer came
  };

  Parts& parts_;
  RealtimeWatch watch_;
  StepGate& gate_;
  TakeOver take_over_;
  Phase phase_ = Phase::kWaiting;
  Grid grid_;
  // The time until which a late tick waits for the roles to finish the previous step.
  std::optional<TimePoint> finish_by_{};
  std::array<Sent, kRingSteps> sent_{};
  std::optional<TimePoint> give_up_at_{};  // end of the wait for the recorder at the end of the run
  Search search_;
};

}  // namespace fogline::runtime
