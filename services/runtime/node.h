// One role's part in a run: joining, taking inputs, publishing, status. What the role computes is
// added by StepNode (any Algorithm) and by the recorder, and when it computes by a FireRule
// (lockstep or real time); this class knows bytes, steps and channels only.
//
// Thread: everything happens on the one thread that calls Bus::Wait() and Poll().
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "services/graph.h"
#include "services/runtime/answer_budget.h"
#include "services/runtime/bus.h"
#include "services/runtime/clock.h"
#include "services/runtime/flood_gate.h"
#include "services/runtime/runner_watch.h"
#include "services/runtime/scenario_parts.h"
#include "services/runtime/step_ring.h"

namespace fogline {

class FireRule;

class Node {
 public:
  /// It says how it is at least so often.
  static constexpr Duration kHeartbeat = milliseconds(200);

  /// @param run_id take part in this run only; without it, in the first that waits for the role
  Node(Bus& bus, Role role, std::optional<std::int64_t> run_id);
  virtual ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Does what time demands (repair, status). Call it after every Bus::Wait().
  /// @return when it wants to be called again at the latest
  TimePoint Poll(TimePoint now);

  /// True once the runner has said STOP, or the role has failed and said so.
  bool left() const { return left_; }
  /// It has not heard all of a scenario yet.
  bool Waits() const { return status_.state == status_t::WAITING; }
  /// It takes no part in its run any more, and another node may take part in another one.
  bool released() const { return status_.state == status_t::LEFT; }
  /// Gives up its place in the run, and says why.
  void Release(const std::string& why);
  /// Whether its runner has been silent for so long that it may go to another run.
  bool RunnerSilent(TimePoint now) { return runner_.Silent(runner_.Attend(now)); }
  /// @pre it is in a run
  std::int64_t run_id() const { return *run_id_; }
  /// Why the role failed, "" if it did not.
  const std::string& error() const { return status_.error; }
  Role role() const { return role_; }
  /// Whether the run is one in real time. Known when Configure() is called.
  bool realtime() const { return realtime_; }

  /// Ends the part in the run for a reason from outside (a signal): what is there is kept.
  void Leave();

 protected:
  /// One channel that the node reads.
  struct Input {
    std::size_t channel;       // in kChannels
    std::int64_t fingerprint;  // of its type
    std::int64_t lag;          // step k is made of its step k - lag
    bool on_demand;  // read in this scenario, not in every one; in real time not waited for
    StepRing ring;
    TimePoint heard{};

    /// What a step is made of is there; before the run there is nothing.
    bool ReadyFor(std::int64_t step) const { return step < lag || ring.Has(step - lag); }
  };
  /// One channel that the node writes.
  struct Output {
    std::size_t channel;
    Bus::Topic& topic;
    StepRing ring;
    std::array<TimePoint, kRingSteps> answered{};  // when its steps were published again
  };

  /// The scenario is here: make the algorithm. @throws std::exception with what is wrong
  virtual void Configure(const Scenario& scenario) = 0;
  /// Why an input is to be refused whatever its step; nullptr if it is sound.
  virtual RefusalCounter Wrong(std::size_t input, Arrival& arrival) = 0;
  /// Takes an input that is new into the place for its step, unless it is Wrong().
  virtual RefusalCounter Accept(std::size_t input, std::int64_t step, Arrival& arrival) = 0;
  /// Computes a step; all inputs are there. Calls Emit() for every output.
  virtual void Compute(std::int64_t step) = 0;
  /// The rule by which steps are computed from now on; Configure() has succeeded.
  virtual std::unique_ptr<FireRule> MakeRule(const Scenario& scenario);
  /// Called before every STATUS: what it says must be true by then.
  virtual void BeforeStatus() {}
  /// Called once when the node leaves.
  virtual void OnLeave() {}
  /// A message of a step that is not what is known of it already.
  virtual std::string Contradiction(std::int64_t step, const ChannelInfo& channel) const;
  /// Someone asks for a STATUS that shows at least this step.
  virtual void OnStatusAsked(std::int64_t /*step*/, TimePoint /*now*/) {}
  /// Someone asks for these steps of a channel, whoever its producer is.
  virtual void OnAsked(std::string_view /*channel*/, StepRange /*steps*/, TimePoint /*now*/) {}

  /// Publishes the output of a step on one of the role's channels (its place in kChannels) and
  /// keeps it. What the recorder answers for is kept only.
  /// @throws std::runtime_error if it is too large
  void Emit(std::size_t channel, std::int64_t step, Bytes bytes);
  /// Ends the node's part in the run with an error.
  void Fail(const std::string& error);
  void SetState(std::int8_t state);
  void PublishStatus();
  void Ask(std::string_view channel, StepRange steps) { Ask(*run_id_, channel, steps); }
  /// Publishes again what somebody has asked for, unless too much was asked for lately.
  void Answer(std::string_view channel, Bytes bytes, TimePoint now);
  /// The steps before this one are done, by a predecessor. Call it in Configure().
  void StartAt(std::int64_t step);
  /// Reads this channel, too (its place in kChannels). Call it in Configure().
  void ReadOnDemand(std::size_t channel) { Read(channel, true); }

  Bus& bus() { return bus_; }
  /// @pre the node has joined
  FireRule& rule() { return *rule_; }
  /// Simulated seconds per second, 0 if there is no limit.
  double pace() const { return pace_; }
  /// In real time: cars in a minimal risk manoeuvre, as the runner knows; bits of status_t.
  std::int8_t minimal_risk() const { return minimal_risk_; }
  std::vector<Input>& inputs() { return inputs_; }
  std::int64_t next() const { return next_; }
  /// Last step that the world has begun, as far as the runner knows; -1 before the first.
  std::int64_t progress() const { return progress_; }
  const ScenarioParts& parts() const { return parts_; }
  std::int8_t state() const { return status_.state; }
  bool Running() const {
    return !left_ && (status_.state == status_t::READY || status_.state == status_t::RUNNING);
  }
  status_t& status() { return status_; }

  /// What a node answers of steps that are over. Repairs on a network that loses a third take a few
  /// hundred a second.
  AnswerBudget budget_{2000, 500};

 private:
  void Read(std::size_t channel, bool on_demand);
  void OnRun(Bytes bytes);
  /// A run that is not this node's says something.
  void OnOtherRun(const run_t& run, TimePoint now);
  /// Whether the runner can be believed to have said this just now, and not in an old run. Asks it,
  /// if that is not known.
  bool IsFresh(const run_t& run, TimePoint now);
  /// Asks a runner to say something to this process.
  void AskWhetherThere(const run_t& run, TimePoint now);
  /// Has what could not be sent told soon; in lockstep fails if that was everything for too long.
  void CheckSends(TimePoint now);
  /// Takes what the runner says of the run as a whole, if it says it for the first time.
  bool TakeNews(const run_t& run, TimePoint now);
  /// Forgets a run whose runner has fallen silent before all of it was known.
  void Unbind();
  void OnInput(std::size_t index, Arrival& arrival);
  void Ask(std::int64_t run_id, std::string_view channel, StepRange steps);
  /// Counts a message that is not taken.
  void Refuse(RefusalCounter kind) { ++(status_.*kind); }
  void OnResend(Bytes bytes);
  void AnswerFrom(Output& output, StepRange steps, TimePoint now);
  void Join(const run_t& run);
  void TakeInput(std::size_t index, std::int64_t step, Arrival& arrival);
  bool ComputeNow(std::int64_t step);

  friend class FireRule;

  Bus& bus_;
  const Role role_;
  const bool chosen_;  // the run, by option: no other one is looked for
  std::optional<std::int64_t> run_id_;
  bool bound_;  // to the run of run_id_: by option, or since a run was announced
  bool fresh_;  // the runner has answered this process, or without a key it need not
  AnswerBudget questions_{200, 20};  // to runners, whether they are still there
  FloodGate requests_{3000};         // many times what the worst network makes necessary
  std::int64_t sequence_ = 0;        // newest word of the runner
  ScenarioParts parts_;
  std::vector<Input> inputs_;
  std::vector<Output> outputs_;
  std::unique_ptr<FireRule> rule_;  // since the node has joined
  bool realtime_ = false;
  double pace_ = 0;
  std::int8_t minimal_risk_ = 0;
  std::int64_t next_ = 0;  // step to compute next
  std::int64_t progress_ = -1;
  std::int64_t steps_ = kMaxStep;  // of the scenario, once it is known
  bool left_ = false;
  status_t status_{};
  std::vector<std::uint8_t> buffer_;

  TimePoint part_at_{};       // when to ask for a part of the scenario
  TimePoint announced_at_{};  // when a repeated announcement was answered
  TimePoint said_at_{};       // a STATUS, last
  TimePoint status_at_{};
  TimePoint use_at_{};
  RunnerWatch runner_{Clock::now()};
  const bool ends_with_runner_;  // which has started it: the kernel sees to that
};

}  // namespace fogline
