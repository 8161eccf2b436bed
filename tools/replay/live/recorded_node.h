// A role that computes nothing: in each step it publishes the messages of a log. Like other roles
// it takes part in a run in lockstep and in real time.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/runtime/node/node.h"
#include "tools/replay/live/recorded_messages.h"

namespace fogline::replay {

class RecordedNode final : public runtime::Work {
 public:
  /// @param messages recorded messages on the channels of the role
  RecordedNode(runtime::Bus& bus, Role role, std::int64_t run_id, const RecordedMessages& messages);

  runtime::Node& node() override { return node_; }

 private:
  std::unique_ptr<runtime::FireRule> Join(const Scenario& scenario) override;
  /// Publishes the messages of a step. In real time it omits a message that the log lacks.
  /// @throws std::runtime_error in lockstep for a message that the log lacks
  void Compute(std::int64_t step) override;

  runtime::Node node_;
  const RecordedMessages& messages_;
  std::vector<std::size_t> own_;  // the role's channels, as indices in messages_.channels()
  std::vector<std::uint8_t> bytes_;
};

}  // namespace fogline::replay
