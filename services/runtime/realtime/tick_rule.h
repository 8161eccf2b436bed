// The real-time rule for the role that begins the steps (the world): one step at each tick of the
// wall clock, even if roles have not answered.
//
// Step k is due k periods after the start, on a grid that does not drift. While the process or its
// machine is stopped, ticks pass without a step. They are not made up for: only the last of them
// begins a step. After a stop of the machine the step before may not be finished. The other roles
// then get a moment for it, and the next tick keeps a distance from the late one. Simulated time is
// the number of steps. So it stands still with the world's process, and no step is ever left out.
// Missed ticks are counted.
//
// A world that is started again continues after the last TRUTH that the recorder has.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "services/runtime/lockstep/step_gate.h"
#include "services/runtime/realtime/realtime_rule.h"

namespace fogline::runtime {

class TickRule final : public RealtimeRule {
 public:
  /// Takes over after the step of `truth`, and computes the steps that are known to be under way
  /// without publishing them.
  using TakeOver = std::function<void(const truth_t& truth)>;

  TickRule(Node& node, const Scenario& scenario, double speed, StepGate& gate, TakeOver take_over);

  void OnGo(const run_t& run, TimePoint now) override;
  StepRing::Verdict Classify(std::size_t input, std::int64_t step, Bytes bytes) override;
  void OnInput(std::size_t input, std::int64_t step, TimePoint time) override;
  void SetFinal(std::int64_t step) override;
  void WriteStatus(TimePoint now) override;

 private:
  enum class Phase { kWaiting, kResuming, kTicking, kEnding };

  TimePoint Fire(TimePoint now) override;
  TimePoint LookForTruth(TimePoint now);
  /// The first of the steps that a restarted world asks for.
  std::int64_t FirstAsked();
  /// Whether the world can continue after this TRUTH.
  bool CanResume(const truth_t& truth);
  TimePoint Resume(TimePoint now);
  TimePoint Tick(TimePoint now);
  TimePoint End(TimePoint now);
  /// Takes the latency of a step's command, which has come in time or late. Each step counts once.
  void TakeLatency(std::size_t input, std::int64_t step, TimePoint time);
  /// Whether the commands for the next step are there, or it needs none.
  bool Answered() const;
  /// When tick `n` of the grid is due.
  TimePoint Due(std::int64_t n) const;

  StepGate& gate_;
  TakeOver take_over_;
  std::int64_t steps_;  // of the scenario
  Phase phase_ = Phase::kWaiting;

  TimePoint start_{};
  std::int64_t tick_ = 0;  // next tick on the grid
  std::int64_t ticks_missed_ = 0;
  // The latest time until which a late tick waits for the step before.
  std::optional<TimePoint> finish_by_{};
  /// A published step whose command has not come yet.
  struct Sent {
    std::int64_t step = -1;
    TimePoint time{};
  };
  std::array<Sent, kRingSteps> sent_{};
  std::optional<TimePoint> give_up_at_{};  // end of the wait for the recorder at the end of the run

  std::optional<truth_t> truth_;  // newest TRUTH that has come as an answer
  TimePoint truth_at_{};          // when the first one came
  TimePoint ask_at_{};
  bool subscribed_ = false;
};

}  // namespace fogline::runtime
