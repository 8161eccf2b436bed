// Which old steps others have asked for and have not been given yet.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "services/runtime/step_ring.h"

namespace fogline {

/// A set of channels of steps. A request that is repeated adds nothing, so many roles that repeat
/// theirs get no more answers than one. The answers come in the order of the steps, as roles that
/// catch up need them. After the last step the first one comes again, so every request is answered.
class AskedSteps {
 public:
  /// Channels by place in kChannels, a bit for each.
  using Channels = std::uint32_t;
  struct Asked {
    std::int64_t step;
    Channels channels;
  };

  /// The most that is remembered. Who is forgotten asks again; all roles of a run together, each at
  /// a place of its own, ask for a seventh of it.
  static constexpr std::size_t kMost = 4096;

  void Add(std::int64_t step, Channels channels) {
    if (steps_.size() < kMost || steps_.contains(step)) steps_[step] |= channels;
  }
  /// The next step, and what is to be given of it.
  std::optional<Asked> Take() {
    if (steps_.empty()) return std::nullopt;
    auto next = steps_.lower_bound(from_);
    if (next == steps_.end()) next = steps_.begin();
    const Asked asked{.step = next->first, .channels = next->second};
    steps_.erase(next);
    from_ = asked.step + 1;
    return asked;
  }
  bool empty() const { return steps_.empty(); }

 private:
  std::map<std::int64_t, Channels> steps_;
  std::int64_t from_ = 0;  // the step that comes next, or the one after it that was asked for
};

}  // namespace fogline
