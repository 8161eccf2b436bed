// The old steps that roles have asked for, and that the recorder has not sent yet.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "services/runtime/wire/step_ring.h"

namespace fogline::recorder {

/// A set of steps, and for each step the requested channels. A repeated request adds nothing, so
/// many repetitions get only one answer. Take() goes through the steps in their order, because
/// roles that catch up need the steps in this order. After the last step, Take() begins again at
/// the first step, so every request is answered.
class AskedSteps {
 public:
  /// One bit for each channel, at the channel's index in kChannels.
  using Channels = std::uint32_t;
  struct Asked {
    std::int64_t step;
    Channels channels;
  };

  /// The largest number of steps in the set. If the set is full, Add() drops a request for a
  /// further step, and the role asks again. Even if all roles of a run ask for different steps at
  /// the same time, they ask for only a seventh of this number.
  static constexpr std::size_t kMost = 4096;

  void Add(std::int64_t step, Channels channels) {
    if (steps_.size() < kMost || steps_.contains(step)) steps_[step] |= channels;
  }
  /// Removes and returns the next step and its channels; nullopt if no step is requested.
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
  std::int64_t from_ = 0;  // Take() returns the first requested step from this number on
};

}  // namespace fogline::recorder
