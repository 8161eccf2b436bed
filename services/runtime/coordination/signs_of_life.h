// If no message of a process comes, either the process sends no messages, or the network loses
// them. This class computes the probability that the network loses all messages of a living
// process. All processes send at the same intervals over the same network. So the probability
// follows from the share of lost messages among the messages of the other processes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "common/clock.h"
#include "services/graph.h"

namespace fogline::runtime {

class SignsOfLife {
 public:
  /// @param every the longest interval between two messages of a living process
  explicit SignsOfLife(Duration every) : every_(every) {}

  /// Notes that a message of a role has come. @param lost how many messages of the role were lost
  /// just before this message
  void Heard(Role role, std::int64_t lost, TimePoint now) {
    ++heard_;
    lost_ += std::max<std::int64_t>(0, lost);
    Since(role, now);
  }
  /// Notes that a process of the role was started, so its messages can come from `now` on.
  void Since(Role role, TimePoint now) {
    since_[static_cast<std::size_t>(role)] = {.time = now, .heard = heard_, .lost = lost_};
  }

  /// The probability that the network loses all messages that a living role sends in the time
  /// `silence`; 1 if no message of another role has come since the role's last message.
  /// @param silence the time since the role's last message, without the time in which this process
  ///     could not receive messages
  double ChanceOfLife(Role role, Duration silence) const {
    const Mark& last = since_[static_cast<std::size_t>(role)];
    const auto others =
        std::ranges::count_if(since_, [&](const Mark& mark) { return mark.time > last.time; });
    if (others == 0) return 1;
    const double signs = Seconds(silence) / Seconds(every_);
    const auto heard = static_cast<double>(heard_ - last.heard);
    const auto lost = static_cast<double>(lost_ - last.lost);
    // The share of lost messages is the larger of two estimates. The first estimate compares the
    // number of received messages with the smallest number of messages that the other roles can
    // have sent. The second estimate uses the number of messages that are known to be lost, because
    // their sequence numbers are missing.
    const double share_lost =
        std::max(1 - heard / (static_cast<double>(others) * signs), lost / (heard + lost));
    return std::pow(std::clamp(share_lost, 0.0, 1.0), signs);
  }

 private:
  /// When the last message of a role came, and how many messages of all roles had come or been lost
  /// by then.
  struct Mark {
    TimePoint time{};
    std::int64_t heard = 0;
    std::int64_t lost = 0;
  };
  Duration every_;
  std::int64_t heard_ = 0;
  std::int64_t lost_ = 0;
  std::array<Mark, kRoles.size()> since_{};
};

}  // namespace fogline::runtime
