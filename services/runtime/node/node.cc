#include "services/runtime/node/node.h"

#include <algorithm>

namespace fogline::runtime {

Node::Node(Bus& bus, Role role, std::optional<std::int64_t> run_id, Work& work)
    : work_(work),
      parts_(bus, role, work, rule_),
      membership_(parts_, run_id, work, rule_),
      outputs_(parts_, role, work, rule_) {}

TimePoint Node::Poll(TimePoint now) {
  const TimePoint heartbeat = now + OwnStatus::kHeartbeat;
  OwnStatus& own = parts_.own;
  if (own.left() || own.released()) return heartbeat;
  TimePoint next = std::min(heartbeat, membership_.Poll(now));
  if (own.left()) return heartbeat;
  if (own.Running()) {
    next = std::min(next, work_.Poll(now));
    next = std::min(next, rule_->Poll(now));
  }
  return std::min(next, own.Poll(now));
}

}  // namespace fogline::runtime
