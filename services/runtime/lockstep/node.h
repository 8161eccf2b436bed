// One role's part in a run: joining, taking inputs, publishing, status. StepNode (for any
// Algorithm) and the recorder add what the role computes. A FireRule (lockstep or real time)
// decides when it computes. This class knows only bytes, steps and channels.
//
// Thread: everything happens on the one thread that calls Bus::Wait() and Poll().
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/clock.h"
#include "scenario/sections/scenario.h"
#include "services/graph.h"
#include "services/runtime/node/rate_limiter.h"
#include "services/runtime/node/runner_watch.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/load_shedder.h"
#include "services/runtime/wire/scenario_parts.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

class FireRule;

class Node {
 public:
  /// The longest time between two STATUS messages of a node.
  static constexpr Duration kHeartbeat = milliseconds(200);

  /// @param run_id take part only in this run; nullopt: in the first run that waits for the role
  Node(Bus& bus, Role role, std::optional<std::int64_t> run_id);
  virtual ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Does what is due (repair, status). Call it after every Bus::Wait().
  /// @return the latest time for the next call
  TimePoint Poll(TimePoint now);

  /// True once the runner has said STOP, or the role has failed and said so.
  bool left() const { return left_; }
  /// Whether it has not received the whole scenario of a run yet.
  bool Waits() const { return status_.state == status_t::WAITING; }
  /// Whether it has left its run, so that another node of this process may take part in another
  /// run.
  bool released() const { return status_.state == status_t::LEFT; }
  /// Gives up its place in the run. @param why the reason, which its STATUS reports
  void Release(const std::string& why);
  /// Whether its runner has been silent for so long that the role may join another run.
  bool RunnerSilent(TimePoint now) { return runner_.Silent(runner_.Attend(now)); }
  /// @pre the node is in a run
  std::int64_t run_id() const { return *run_id_; }
  /// Why the role failed, "" if it did not.
  const std::string& error() const { return status_.error; }
  Role role() const { return role_; }
  /// Whether the run is in real time. It is known when Configure() is called.
  bool realtime() const { return realtime_; }

  /// Ends the node's part in the run for an outside reason (a signal). Existing results are kept.
  void Leave();

 protected:
  /// One channel that the node reads.
  struct Input {
    std::size_t channel;       // in kChannels
    std::int64_t fingerprint;  // of its type
    std::int64_t lag;          // step k uses this input's step k - lag
    bool on_demand;  // an input on demand (algorithm.h); in real time the node does not wait for it
    StepRing ring;
    TimePoint heard{};

    /// Whether this input has the message that a step uses. A step whose message would be from
    /// before step 0 uses none.
    bool ReadyFor(std::int64_t step) const { return step < lag || ring.Has(step - lag); }
  };
  /// One channel that the node writes.
  struct Output {
    std::size_t channel;
    Bus::Topic& topic;
    StepRing ring;
    std::array<TimePoint, kRingSteps> answered{};  // when its steps were last published again
  };

  /// Called when the whole scenario is here: makes the algorithm.
  /// @throws std::exception that says what is wrong
  virtual void Configure(const Scenario& scenario) = 0;
  /// Why a message of an input is to be refused, whatever its step; nullptr if it is sound.
  virtual RefusalCounter Wrong(std::size_t input, Arrival& arrival) = 0;
  /// Stores a new message of an input for its step, unless it is Wrong().
  /// @return the result of Wrong()
  virtual RefusalCounter Accept(std::size_t input, std::int64_t step, Arrival& arrival) = 0;
  /// Computes a step. All its inputs are there. It must call Emit() for every output.
  virtual void Compute(std::int64_t step) = 0;
  /// Makes the rule that decides when steps are computed. Called after Configure() has succeeded.
  virtual std::unique_ptr<FireRule> MakeRule(const Scenario& scenario);
  /// Called before every STATUS, to make sure that its claims are true.
  virtual void BeforeStatus() {}
  /// Called once when the node leaves.
  virtual void OnLeave() {}
  /// The error text for a message that contradicts an earlier message of the same step and channel.
  virtual std::string Contradiction(std::int64_t step, const ChannelInfo& channel) const;
  /// Another process asks for a STATUS that shows at least this step.
  virtual void OnStatusAsked(std::int64_t /*step*/, TimePoint /*now*/) {}
  /// Another process asks for these steps of a channel. This node need not be its producer.
  virtual void OnAsked(std::string_view /*channel*/, StepRange /*steps*/, TimePoint /*now*/) {}

  /// Publishes the output of a step on one of the role's channels (its place in kChannels) and
  /// keeps it. A step that the recorder answers for is only kept.
  /// @throws std::runtime_error if it is too large
  void Emit(std::size_t channel, std::int64_t step, Bytes bytes);
  /// Ends the node's part in the run with an error.
  void Fail(const std::string& error);
  void SetState(std::int8_t state);
  void PublishStatus();
  void Ask(std::string_view channel, StepRange steps) { Ask(*run_id_, channel, steps); }
  /// Publishes a requested message again, unless the rate limiter (limiter_) refuses.
  void Answer(std::string_view channel, Bytes bytes, TimePoint now);
  /// A predecessor has done the steps before this one. Call it in Configure().
  void StartAt(std::int64_t step);
  /// Reads this channel, too (its place in kChannels). Call it in Configure().
  void ReadOnDemand(std::size_t channel) { Read(channel, true); }

  Bus& bus() { return bus_; }
  /// @pre the node has joined
  FireRule& rule() { return *rule_; }
  /// Simulated seconds per second, 0 if there is no limit.
  double pace() const { return pace_; }
  /// In real time: the cars in a minimal risk manoeuvre, by the runner's word; bits of status_t.
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

  /// A rate limiter for answers about older steps, in messages per second and per burst. Repairs on
  /// a network that loses a third of the messages take a few hundred a second.
  RateLimiter limiter_{2000, 500};

 private:
  void Read(std::size_t channel, bool on_demand);
  void OnRun(Bytes bytes);
  /// Handles a RUN of another run.
  void OnOtherRun(const run_t& run, TimePoint now);
  /// Whether the runner has sent this RUN now, not in an old run. If that is not known, asks the
  /// runner.
  bool IsFresh(const run_t& run, TimePoint now);
  /// Asks a runner for a RUN that answers this process.
  void AskWhetherThere(const run_t& run, TimePoint now);
  /// Sends a STATUS soon after a failed send. In lockstep the node fails if nothing could be sent
  /// for as long as the run waits for a step.
  void CheckSends(TimePoint now);
  /// Takes a RUN's news about the whole run. @return whether the RUN is newer than all before
  bool TakeNews(const run_t& run, TimePoint now);
  /// Forgets a run whose runner fell silent before the whole scenario had come.
  void Unbind();
  void OnInput(std::size_t index, Arrival& arrival);
  void Ask(std::int64_t run_id, std::string_view channel, StepRange steps);
  /// Counts a message that is refused.
  void Refuse(RefusalCounter kind) { ++(status_.*kind); }
  void OnResend(Bytes bytes);
  void AnswerFrom(Output& output, StepRange steps, TimePoint now);
  void Join(const run_t& run);
  void TakeInput(std::size_t index, std::int64_t step, Arrival& arrival);
  bool ComputeNow(std::int64_t step);

  friend class FireRule;

  Bus& bus_;
  const Role role_;
  const bool chosen_;  // whether an option names the run: then the node looks for no other run
  std::optional<std::int64_t> run_id_;
  bool bound_;  // belongs to the run run_id_: by option, or because that run was announced
  bool fresh_;  // the runner has answered this process, or there is no key and it need not
  RateLimiter questions_{200, 20};  // limits the requests that ask runners for an answer
  LoadShedder requests_{3000};      // RESEND per second: many times the number on the worst network
  std::int64_t sequence_ = 0;       // of the newest RUN
  ScenarioParts parts_;
  std::vector<Input> inputs_;
  std::vector<Output> outputs_;
  std::unique_ptr<FireRule> rule_;  // set once the node has joined
  bool realtime_ = false;
  double pace_ = 0;
  std::int8_t minimal_risk_ = 0;
  std::int64_t next_ = 0;  // step to compute next
  std::int64_t progress_ = -1;
  std::int64_t steps_ = kMaxStep;  // number of steps, once the scenario is known
  bool left_ = false;
  status_t status_{};
  std::vector<std::uint8_t> buffer_;

  TimePoint part_at_{};       // when to ask for the next part of the scenario
  TimePoint announced_at_{};  // when a repeated announcement was last answered
  TimePoint said_at_{};       // when the last STATUS was sent
  TimePoint status_at_{};
  TimePoint use_at_{};
  RunnerWatch runner_{Clock::now()};
  // The runner has started this process, and the kernel ends both together.
  const bool ends_with_runner_;
};

}  // namespace fogline::runtime
