// When a node computes a step, and what it does about missing inputs. This is all that differs
// between a run in lockstep (lockstep_rule.h) and one in real time (realtime_rule.h).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "common/clock.h"
#include "services/runtime/lockstep/node.h"

namespace fogline::runtime {

/// The rule of one node, from when the node has joined a run. It has access only to the parts of
/// the node that the protected functions below give it.
class FireRule {
 public:
  virtual ~FireRule() = default;
  FireRule(const FireRule&) = delete;
  FireRule& operator=(const FireRule&) = delete;

  /// The runner says GO. May be called repeatedly.
  virtual void OnGo(const run_t& /*run*/, TimePoint /*now*/) {}
  /// Decides what to do with an input's message of a step.
  virtual StepRing::Verdict Classify(std::size_t input, std::int64_t step, Bytes bytes) = 0;
  /// An input's message of a step is new and has been stored in its ring.
  virtual void OnInput(std::size_t input, std::int64_t step, TimePoint time) = 0;
  /// Does what is due. @return the latest time for the next call
  virtual TimePoint Poll(TimePoint now) = 0;
  /// A RUN has told how far the run is.
  virtual void OnProgress() {}
  /// The next step is known to be under way.
  virtual void Expect(std::int64_t /*step*/) {}
  /// Another process asks for the output of a step that this node has not computed yet.
  virtual void OnAskedAhead(std::int64_t /*step*/, TimePoint /*now*/) {}
  /// Called before every STATUS: adds what the rule knows.
  virtual void WriteStatus(TimePoint /*now*/) {}
  /// This step is the last one of the run.
  virtual void SetFinal(std::int64_t /*step*/) {}

 protected:
  using Input = Node::Input;

  explicit FireRule(Node& node) : node_(node) {}

  std::vector<Input>& inputs() { return node_.inputs_; }
  const std::vector<Input>& inputs() const { return node_.inputs_; }
  /// The step to compute next. It uses each input's message of step next() - lag.
  std::int64_t next() const { return node_.next_; }
  std::int64_t progress() const { return node_.progress_; }
  bool Running() const { return node_.Running(); }
  status_t& status() { return node_.status_; }
  Bus& bus() { return node_.bus_; }
  /// Computes a step now. The next step is then the one after it.
  /// @return false if the computation failed
  bool Compute(std::int64_t step) { return node_.ComputeNow(step); }
  void Ask(std::string_view channel, StepRange steps) { node_.Ask(channel, steps); }
  void PublishStatus() { node_.PublishStatus(); }
  void SetState(std::int8_t state) { node_.SetState(state); }
  static constexpr Duration kHeartbeat = Node::kHeartbeat;

 private:
  Node& node_;
};

}  // namespace fogline::runtime
