// The work of a role in a run. The role's Node does everything else: joining, inputs, outputs,
// STATUS.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "common/clock.h"
#include "scenario/sections/scenario.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

class FireRule;
class Node;

/// One role's work. The role's Node calls these functions, on the one thread that calls Bus::Wait()
/// and Node::Poll().
class Work {
 public:
  virtual ~Work() = default;
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// The role's node, which does everything except this work.
  virtual Node& node() = 0;
  /// Prepares for a run. Called when the whole scenario has come.
  /// @return the rule that decides when steps are computed
  /// @throws std::exception that says what is wrong
  virtual std::unique_ptr<FireRule> Join(const Scenario& scenario) = 0;
  /// Computes a step, and publishes all its outputs (Outputs). Called when the FireRule of Join()
  /// has decided that the role computes this step now.
  /// @throws std::exception that says what is wrong
  virtual void Compute(std::int64_t step) = 0;
  /// Does work that is due but does not belong to a step. Called before FireRule::Poll(), while the
  /// role is READY or RUNNING. @return the latest time for the next call
  virtual TimePoint Poll(TimePoint /*now*/) { return TimePoint::max(); }
  /// Called before every STATUS. The role finishes the work that the STATUS reports as done. For
  /// example, the recorder flushes its log.
  virtual void BeforeStatus() {}
  /// Called exactly once, when the role's part in its run ends (OwnStatus::left()). Not called when
  /// the role gives up its place in the run (OwnStatus::Release()).
  virtual void OnLeave() {}
  /// Called when another process asks for a STATUS that shows at least this step.
  virtual void OnStatusAsked(std::int64_t /*step*/) {}
  /// Called when another process asks for these steps of a channel. The channel's producer may be
  /// another role.
  virtual void OnAsked(std::string_view /*channel*/, StepRange /*steps*/, TimePoint /*now*/) {}

 protected:
  Work() = default;
};

}  // namespace fogline::runtime
