// A limit for floods of messages: a process lets in as many messages as it can handle. The kernel
// drops the rest before it fills the receive buffer. That costs nothing.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "common/clock.h"

namespace fogline::runtime {

class LoadShedder {
 public:
  /// @param per_second messages that the process can handle
  explicit constexpr LoadShedder(double per_second) : per_second_(per_second) {}

  /// Counts a message that has come. @return the share of messages to let in from now on, if that
  /// changes
  std::optional<double> Count(TimePoint now) {
    ++count_;
    const std::chrono::duration<double> passed = now - since_;
    if (passed < kWindow) return std::nullopt;
    // Only share_ of the sent messages came.
    const double sent = count_ / passed.count() / share_;
    since_ = now;
    count_ = 0;
    const double share = std::clamp(per_second_ / sent, kLeast, 1.0);
    // A change costs a system call, so a share within a fifth of the wanted one is kept.
    if (share > 0.8 * share_ && share < 1.2 * share_ && !(share == 1 && share_ < 1)) {
      return std::nullopt;
    }
    share_ = share;
    return share_;
  }

 private:
  static constexpr std::chrono::milliseconds kWindow{50};
  // The smallest share: enough to notice the end of a flood.
  static constexpr double kLeast = 1e-3;

  double per_second_;
  double share_ = 1;
  double count_ = 0;
  TimePoint since_{};
};

}  // namespace fogline::runtime
