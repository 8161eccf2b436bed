// Decides when a role computes a step, and what the role does about missing inputs. A role in
// lockstep (lockstep_rule.h) and a role in real time (realtime_rule.h) differ only in this rule.
#pragma once

#include <cstdint>

#include "common/clock.h"
#include "fogline/run_t.hpp"
#include "services/runtime/wire/arrival.h"

namespace fogline::runtime {

/// Decides when one role computes a step, and what the role does if inputs are missing. The rule is
/// made when the role joins a run. Its constructor gets the parts of the node (parts.h).
class FireRule {
 public:
  virtual ~FireRule() = default;
  FireRule(const FireRule&) = delete;
  FireRule& operator=(const FireRule&) = delete;

  /// Called when the runner says GO. May be called repeatedly.
  virtual void OnGo(const run_t& /*run*/, TimePoint /*now*/) {}
  /// Called when a message of `input` (an index in Inputs::all()) has come. The message is of this
  /// run and of a step of the scenario. The rule judges the message and passes it to
  /// Inputs::Keep().
  virtual void OnInput(std::size_t input, std::int64_t step, Arrival& arrival) = 0;
  /// Does what is due. @return the latest time for the next call
  virtual TimePoint Poll(TimePoint now) = 0;
  /// Called when a RUN has reported the progress of the run (RunNews::progress).
  virtual void OnProgress() {}
  /// Notes that the run has reached this step.
  virtual void Expect(std::int64_t /*step*/) {}
  /// Called when another process asks for the output of a step that this role has not computed yet.
  virtual void OnAskedAhead(std::int64_t /*step*/, TimePoint /*now*/) {}
  /// Called before every STATUS. Adds to the STATUS what the rule knows.
  virtual void WriteStatus(TimePoint /*now*/) {}
  /// Notes that this step is the last step of the run.
  virtual void SetFinal(std::int64_t /*step*/) {}

 protected:
  FireRule() = default;
};

}  // namespace fogline::runtime
