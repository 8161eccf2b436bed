// One role's part in a run: joining, lockstep, repair and status. What the role computes is added
// by StepNode (any Algorithm) and by the recorder; this class knows bytes, steps and channels only.
//
// Lockstep. A node keeps a ring of messages per input and computes step k exactly once, when all
// its inputs for step k are there, in whatever order they came. It encodes its outputs once and
// keeps the bytes. Nothing is ever sent twice on suspicion: who misses an input asks for it
// (RESEND), and who is asked for what he cannot compute yet asks further up. So any loss below 100
// % only costs time.
//
// Catching up. RUN says how far the world is. A node that joins late (its predecessor was killed)
// computes everything from step 0 on again, from inputs for which it asks many steps at a time. Old
// ones come from the recorder, the last ones from their producers. It publishes only what the
// recorder does not answer for.
//
// Thread: everything happens on the one thread that calls Bus::Wait() and Poll().
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "services/graph.h"
#include "services/runtime/answer_budget.h"
#include "services/runtime/bus.h"
#include "services/runtime/clock.h"
#include "services/runtime/patience.h"
#include "services/runtime/scenario_parts.h"
#include "services/runtime/step_ring.h"

namespace fogline {

class Node {
 public:
  /// @param run_id take part in this run only; without it, in the first that is announced
  Node(Bus& bus, Role role, std::optional<std::int64_t> run_id);
  virtual ~Node() = default;
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Does what time demands (repair, status). Call it after every Bus::Wait().
  /// @return when it wants to be called again at the latest
  TimePoint Poll(TimePoint now);

  /// True once the runner has said STOP, or the role has failed and said so.
  bool left() const { return left_; }
  /// It has not heard all of a scenario yet.
  bool Waits() const { return status_.state == status_t::WAITING; }
  /// Why the role failed, "" if it did not.
  const std::string& error() const { return status_.error; }
  Role role() const { return role_; }

  /// Ends the part in the run for a reason from outside (a signal): what is there is kept.
  void Leave();

 protected:
  /// One channel that the node reads.
  struct Input {
    std::size_t channel;       // in kChannels
    std::int64_t fingerprint;  // of its type
    StepRing ring;
    TimePoint heard{};
  };
  /// One channel that the node writes.
  struct Output {
    std::size_t channel;
    Bus::Topic& topic;
    StepRing ring;
  };

  /// The scenario is here: make the algorithm. @throws std::exception with what is wrong
  virtual void Configure(const Scenario& scenario) = 0;
  /// Why an input is to be refused whatever its step; nullptr if it is sound.
  virtual RefusalCounter Wrong(std::size_t input, Arrival& arrival) = 0;
  /// Takes an input that is new into the place for its step, unless it is Wrong().
  virtual RefusalCounter Accept(std::size_t input, std::int64_t step, Arrival& arrival) = 0;
  /// Computes a step; all inputs are there. Calls Emit() for every output.
  virtual void Compute(std::int64_t step) = 0;
  /// Whether the step may be computed now although its inputs are there.
  virtual bool MayCompute(std::int64_t /*step*/, TimePoint /*now*/) { return true; }
  /// Phase of the run other than PREPARE and STOP.
  virtual void OnGo(const run_t& /*run*/, TimePoint /*now*/) {}
  /// More to do in Poll(); returns when to be called again.
  virtual TimePoint PollMore(TimePoint now) { return now + kHeartbeat; }
  /// Called before every STATUS: what it says must be true by then.
  virtual void BeforeStatus() {}
  /// Called once when the node leaves.
  virtual void OnLeave() {}
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
  void Ask(std::string_view channel, StepRange steps);
  /// Publishes again what somebody has asked for, unless too much was asked for lately.
  void Answer(std::string_view channel, Bytes bytes, TimePoint now);
  /// Computes every step that can be computed.
  void Advance(TimePoint now);
  /// Says that the next step is known to be under way.
  void Expect(std::int64_t step) { expected_ = std::max(expected_, step); }
  /// The same on the word of one who asks; what he may be wrong about is bounded.
  void ExpectAsked(std::int64_t step) { Expect(std::min(step, next_ + kRingSteps - 1)); }
  /// The steps before this one are done, by a predecessor. Call it in Configure().
  void StartAt(std::int64_t step);

  Bus& bus() { return bus_; }
  std::vector<Input>& inputs() { return inputs_; }
  std::int64_t next() const { return next_; }
  /// Last step that the world has begun, as far as the runner knows; -1 before the first.
  std::int64_t progress() const { return progress_; }
  std::int64_t run_id() const { return *run_id_; }
  const ScenarioParts& parts() const { return parts_; }
  std::int8_t state() const { return status_.state; }
  bool Running() const {
    return !left_ && (status_.state == status_t::READY || status_.state == status_t::RUNNING);
  }
  status_t& status() { return status_; }

  /// The world reads the commands of step k - 1 to make step k: its lead is 1. Everybody else's is
  /// 0.
  std::int64_t lead_ = 0;
  /// What a node answers. Repairs on a network that loses a third take a few hundred a second.
  AnswerBudget budget_{2000, 500};

  static constexpr Duration kHeartbeat = milliseconds(200);

 private:
  void OnRun(Bytes bytes);
  void OnInput(std::size_t index, Arrival& arrival);
  /// Counts a message that is not taken.
  void Refuse(RefusalCounter kind) { ++(status_.*kind); }
  void OnResend(Bytes bytes);
  void Join();
  bool InputsReady(std::int64_t step) const;
  /// First input that the next step waits for, or nullptr.
  const Input* FirstMissing() const;
  TimePoint Repair(TimePoint now);
  void AskForMissing(TimePoint now);
  /// Steps from `first` to `last` that an input lacks and that should be asked for together.
  StepRange Lacking(const Input& input, std::int64_t first, std::int64_t last) const;
  /// The next step is older than what was under way when this node joined.
  bool CatchingUp() const { return next_ <= late_; }
  void OnProgress(std::int64_t progress);

  Bus& bus_;
  const Role role_;
  std::optional<std::int64_t> run_id_;
  bool bound_;  // to the run of run_id_: by option, or since a run was announced
  ScenarioParts parts_;
  std::vector<Input> inputs_;
  std::vector<Output> outputs_;
  std::int64_t next_ = 0;       // step to compute next
  std::int64_t expected_ = -1;  // highest step that is known to be under way
  std::int64_t progress_ = -1;
  std::int64_t late_ = -1;   // last step to catch up with
  std::int64_t asked_ = -1;  // last step that was asked for
  bool left_ = false;
  status_t status_{};
  std::vector<std::uint8_t> buffer_;

  Patience patience_;
  TimePoint part_at_{};  // when to ask for a part of the scenario
  TimePoint status_at_{};
  TimePoint use_at_{};
  TimePoint runner_heard_{};
};

}  // namespace fogline
