// Which old steps others have asked for and have not been given yet.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "services/runtime/step_ring.h"

namespace fogline {

/// A set of channels of steps. Who asks again for what is still to come changes nothing, so the
/// answers to many that are in a hurry are no more than those to one. They come step by step, as
/// all who catch up need them, and round and round, so nobody waits for ever behind another.
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
