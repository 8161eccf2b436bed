// The steps of a role, in order. Each step is computed once in lockstep, and at most once in real
// time.
#pragma once

#include <cstdint>
#include <exception>

#include "services/runtime/node/own_status.h"
#include "services/runtime/node/work.h"

namespace fogline::runtime {

class Steps {
 public:
  Steps(OwnStatus& own, Work& work) : own_(own), work_(work) {}

  /// The step to compute next. In lockstep, this step uses the message of step next() from an input
  /// with lag 0, and of step next() - 1 from an input with lag 1 (LagOf() in services/graph.h).
  std::int64_t next() const { return next_; }
  /// Notes that an earlier process of this role has computed the steps before `step`.
  void StartAt(std::int64_t step) {
    next_ = step;
    own_.message().header.step = step - 1;
  }
  /// Computes a step now. next() is then the following step.
  /// @return false if the computation failed; the role has then reported the failure
  bool Compute(std::int64_t step) {
    try {
      work_.Compute(step);
    } catch (const std::exception& error) {
      own_.Fail(error.what());
      return false;
    }
    own_.message().header.step = step;
    next_ = step + 1;
    if (own_.message().state == status_t::READY) own_.SetState(status_t::RUNNING);
    return true;
  }

 private:
  OwnStatus& own_;
  Work& work_;
  std::int64_t next_ = 0;
};

}  // namespace fogline::runtime
