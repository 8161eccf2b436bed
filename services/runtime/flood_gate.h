// How much of a flood a process lets in: what it can cope with, and no more, however much there is.
// The rest is left to the kernel, where it costs nothing, before it takes the place of what counts
// in the receive buffer.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "services/runtime/clock.h"

namespace fogline {

class FloodGate {
 public:
  /// @param per_second messages that are welcome
  explicit constexpr FloodGate(double per_second) : per_second_(per_second) {}

  /// One message has come. @return the share of them to let in from now on, when that changes
  std::optional<double> Count(TimePoint now) {
    ++count_;
    const std::chrono::duration<double> passed = now - since_;
    if (passed < kWindow) return std::nullopt;
    // What came is a share of what was sent.
    const double sent = count_ / passed.count() / share_;
    since_ = now;
    count_ = 0;
    const double share = std::clamp(per_second_ / sent, kLeast, 1.0);
    // Changes cost a system call; a share within a fifth is as good.
    if (share > 0.8 * share_ && share < 1.2 * share_ && !(share == 1 && share_ < 1)) {
      return std::nullopt;
    }
    share_ = share;
    return share_;
  }

 private:
  static constexpr std::chrono::milliseconds kWindow{50};
  // Enough to notice the end of a flood.
  static constexpr double kLeast = 1e-3;

  double per_second_;
  double share_ = 1;
  double count_ = 0;
  TimePoint since_{};
};

}  // namespace fogline
