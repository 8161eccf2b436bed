// One role's part in a run. Membership joins the run, Inputs and Outputs store messages, a FireRule
// decides when a step is computed, and Work computes the step.
//
// All work is done on the one thread that calls Bus::Wait() and Poll().
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/clock.h"
#include "services/graph.h"
#include "services/runtime/node/fire_rule.h"
#include "services/runtime/node/membership.h"
#include "services/runtime/node/outputs.h"
#include "services/runtime/node/parts.h"
#include "services/runtime/node/work.h"
#include "services/runtime/transport/bus.h"

namespace fogline::runtime {

class Node {
 public:
  /// @param run_id the run to join; nullopt: the first run that waits for the role
  /// @param work the role's work, which owns this node
  Node(Bus& bus, Role role, std::optional<std::int64_t> run_id, Work& work);
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Does what is due, such as the requests for missing inputs, the next step, or the STATUS. Call
  /// this function after every Bus::Wait().
  /// @return the latest time for the next call
  TimePoint Poll(TimePoint now);

  Parts& parts() { return parts_; }
  Membership& membership() { return membership_; }
  Outputs& outputs() { return outputs_; }
  /// @pre the role has joined
  FireRule& rule() { return *rule_; }

 private:
  Work& work_;
  std::unique_ptr<FireRule> rule_;  // null until the role has joined
  Parts parts_;
  Membership membership_;
  Outputs outputs_;
};

}  // namespace fogline::runtime
