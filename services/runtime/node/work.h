// What a role does in a run. Its Node does the rest: joining, inputs, outputs, STATUS.
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

/// One role's work. Its Node calls it, on the one thread that calls Bus::Wait() and Node::Poll().
class Work {
 public:
  virtual ~Work() = default;
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// Its place in the run.
  virtual Node& node() = 0;
  /// Gets ready for a run, when the whole scenario is here.
  /// @return the rule that decides when steps are computed
  /// @throws std::exception that says what is wrong
  virtual std::unique_ptr<FireRule> Join(const Scenario& scenario) = 0;
  /// Computes a step, and publishes all its outputs (Outputs). The inputs that the rule demands are
  /// there.
  /// @throws std::exception that says what is wrong
  virtual void Compute(std::int64_t step) = 0;
  /// Does the work that is due beside the steps. Called before the rule's Poll(), while the role is
  /// READY or RUNNING. @return the latest time for the next call
  virtual TimePoint Poll(TimePoint /*now*/) { return TimePoint::max(); }
  /// Called before every STATUS, to make the claims of the STATUS true.
  virtual void BeforeStatus() {}
  /// Called once when the role's part in its run ends (OwnStatus::left()), not at Release().
  virtual void OnLeave() {}
  /// Another process asks for a STATUS that shows at least this step.
  virtual void OnStatusAsked(std::int64_t /*step*/) {}
  /// Another process asks for these steps of a channel. This role need not be its producer.
  virtual void OnAsked(std::string_view /*channel*/, StepRange /*steps*/, TimePoint /*now*/) {}

 protected:
  Work() = default;
};

}  // namespace fogline::runtime
