#include "tools/replay/live/live_roles.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "common/process/priority.h"
#include "services/runtime/transport/bus.h"

namespace fogline::replay {
namespace {

// A thread checks at least this often whether it should end.
constexpr Duration kLookEvery = milliseconds(50);
// Priority of the threads in real time. The processes of roles have the same priority.
constexpr int kPriority = 1;

}  // namespace

LiveRoles::LiveRoles(const RecordedMessages& messages, runtime::TrafficOptions traffic,
                     bool realtime)
    : messages_(messages), traffic_(std::move(traffic)), realtime_(realtime) {}

LiveRoles::~LiveRoles() {
  over_ = true;
  for (const auto& part : parts_) part->thread.join();
}

std::vector<Role> LiveRoles::roles() const {
  std::vector<Role> roles;
  for (const RoleInfo& info : kRoles) {
    const bool is_recorded = std::ranges::any_of(messages_.channels(), [&](std::size_t channel) {
      return kChannels[channel].from == info.role;
    });
    if (is_recorded) roles.push_back(info.role);
  }
  return roles;
}

void LiveRoles::Join(std::int64_t run_id, const std::string& url) {
  for (const Role role : roles()) {
    auto part = std::make_unique<Part>();
    part->bus = runtime::OpenBus(url, traffic_, role);
    part->node = std::make_unique<RecordedNode>(*part->bus, role, run_id, messages_);
    part->thread = std::thread([this, &part = *part] { TakePart(part); });
    parts_.push_back(std::move(part));
  }
}

void LiveRoles::TakePart(Part& part) const {
  // The priority also applies to the thread that this thread starts for the backlog of its bus. The
  // result is not used: the runner itself reports the roles to which the kernel refuses the
  // priority.
  if (realtime_) RunThreadBeforeOthers(kPriority, /*with_its_threads=*/true);
  runtime::Node& node = part.node->node();
  try {
    while (!over_ && !node.parts().own.left()) {
      const TimePoint now = Clock::now();
      part.bus->Wait(std::min(node.Poll(now) - now, kLookEvery));
    }
  } catch (const std::exception& error) {
    node.parts().own.Fail(error.what());  // the runner then reports this error, and ends the run
  }
}

}  // namespace fogline::replay
