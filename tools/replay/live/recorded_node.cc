#include "tools/replay/live/recorded_node.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>

#include "services/runtime/lockstep/lockstep_rule.h"
#include "services/runtime/realtime/realtime_rule.h"

namespace fogline::replay {
namespace {

/// Replaces the run id of a message.
void SetRunId(std::int64_t run_id, std::vector<std::uint8_t>& message) {
  for (std::size_t i = 0; i < sizeof(run_id); ++i) {
    const std::size_t shift = 8 * (sizeof(run_id) - 1 - i);
    message[runtime::kRunIdOffset + i] =
        static_cast<std::uint8_t>(static_cast<std::uint64_t>(run_id) >> shift);
  }
}

}  // namespace

RecordedNode::RecordedNode(runtime::Bus& bus, Role role, std::int64_t run_id,
                           const RecordedMessages& messages)
    : node_(bus, role, run_id, *this), messages_(messages) {
  for (std::size_t i = 0; i < messages_.channels().size(); ++i) {
    if (kChannels[messages_.channels()[i]].from == role) own_.push_back(i);
  }
}

std::unique_ptr<runtime::FireRule> RecordedNode::Join(const Scenario& scenario) {
  runtime::Parts& parts = node_.parts();
  if (parts.run.realtime) return std::make_unique<runtime::RealtimeRule>(parts, scenario);
  return std::make_unique<runtime::LockstepRule>(parts);
}

void RecordedNode::Compute(std::int64_t step) {
  for (const std::size_t i : own_) {
    const std::size_t channel = messages_.channels()[i];
    const runtime::Bytes recorded = messages_.Of(step, i);
    if (recorded.empty() && node_.parts().run.realtime) continue;
    if (recorded.empty()) {
      throw std::runtime_error(
          fmt::format("step {}: the recorded log lacks {}", step, kChannels[channel].name));
    }
    bytes_.assign(recorded.begin(), recorded.end());
    SetRunId(*node_.parts().run.id, bytes_);
    node_.outputs().Publish(channel, step, bytes_);
  }
}

}  // namespace fogline::replay
