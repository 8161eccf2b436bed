// Real time for the role that begins the steps (the world): one step at each tick of the wall
// clock, whoever has answered.
//
// Step k is due k periods after the start, on a grid that does not drift. A tick at which the
// process did not run (it was stopped, or the machine was) is not made up for: of those that are
// over only the last one is begun. When the machine stood still the step before may not be
// finished: the others get a moment for it, and the tick after a late one is not close behind it.
// Simulated time is the number of steps, so it stands still with the world's process, and no step
// is ever left out; what was missed is counted.
//
// A world that is started again goes on behind the last TRUTH that the recorder has.
#pragma once

#include <array>
#include <functional>
#include <optional>

#include "services/runtime/lead_gate.h"
#include "services/runtime/realtime_rule.h"

namespace fogline {

class TickRule final : public RealtimeRule {
 public:
  /// Takes over behind this step, and computes in silence what is known to be under way.
  using TakeOver = std::function<void(const truth_t& truth)>;

  TickRule(Node& node, const Scenario& scenario, double speed, LeadGate& gate, TakeOver take_over);

  void OnGo(const run_t& run, TimePoint now) override;
  StepRing::Verdict Classify(std::size_t input, std::int64_t step, Bytes bytes) override;
  void OnInput(std::size_t input, std::int64_t step, TimePoint time) override;
  void SetFinal(std::int64_t step) override;
  void WriteStatus(TimePoint now) override;

 private:
  enum class Phase { kWaiting, kResuming, kTicking, kEnding };

  TimePoint Fire(TimePoint now) override;
  TimePoint LookForTruth(TimePoint now);
  /// Where the steps begin that a world which is started again asks for.
  std::int64_t FirstAsked();
  /// Whether a TRUTH can be the one to go on from.
  bool CanResume(const truth_t& truth);
  TimePoint Resume(TimePoint now);
  TimePoint Tick(TimePoint now);
  TimePoint End(TimePoint now);
  /// A step's command has come, in time or not: takes its latency, once.
  void TakeLatency(std::size_t input, std::int64_t step, TimePoint time);
  /// The step before the next one has its commands, or there is none.
  bool Answered() const;
  /// When tick `n` of the grid is due.
  TimePoint Due(std::int64_t n) const;

  LeadGate& gate_;
  TakeOver take_over_;
  std::int64_t steps_;  // of the scenario
  Phase phase_ = Phase::kWaiting;

  TimePoint start_{};
  std::int64_t tick_ = 0;  // next one on the grid
  std::int64_t ticks_missed_ = 0;
  std::optional<TimePoint> finish_by_{};  // until then a late tick waits for the step before
  /// A step that is out, until its command has come.
  struct Sent {
    std::int64_t step = -1;
    TimePoint time{};
  };
  std::array<Sent, kRingSteps> sent_{};
  std::optional<TimePoint> give_up_at_{};  // waiting for the recorder at the end

  std::optional<truth_t> truth_;  // newest one that the recorder has sent
  TimePoint truth_at_{};          // when the first one came
  TimePoint ask_at_{};
  bool subscribed_ = false;
};

}  // namespace fogline
