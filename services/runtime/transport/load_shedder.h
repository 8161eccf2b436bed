// Limits floods of messages. A process accepts only a share of the messages, so that it can handle
// them. The kernel drops the other messages before they fill the receive buffer. The dropped
// messages cost the process nothing.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "common/clock.h"

namespace fogline::runtime {

class LoadShedder {
 public:
  /// @param per_second the number of messages that the process can handle in a second
  explicit constexpr LoadShedder(double per_second) : per_second_(per_second) {}

  /// Counts a message that has come. @return the share of messages to accept from now on; nullopt
  /// if the share does not change
  std::optional<double> Count(TimePoint now) {
    ++count_;
    const std::chrono::duration<double> passed = now - since_;
    if (passed < kWindow) return std::nullopt;
    // Of the sent messages, only the share `share_` has come.
    const double sent = count_ / passed.count() / share_;
    since_ = now;
    count_ = 0;
    const double share = std::clamp(per_second_ / sent, kLeast, 1.0);
    // A change costs a system call, so the share stays the same if it differs from the wanted share
    // by less than a fifth. Only a change to 1 (all messages) is always made.
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
