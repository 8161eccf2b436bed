// If a process is not heard, either it is silent, or the network loses its messages. This class
// judges which is the case. All processes speak in the same rhythm over the same network. So the
// share of the other processes' messages that arrives gives the probability that a living process
// is not heard.
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

  /// Takes note of a message of a role. @param lost how many messages of the role were lost just
  /// before this one
  void Heard(Role role, std::int64_t lost, TimePoint now) {
    ++heard_;
    lost_ += std::max<std::int64_t>(0, lost);
    Since(role, now);
  }
  /// Notes that the role can be heard from `now` on.
  void Since(Role role, TimePoint now) {
    since_[static_cast<std::size_t>(role)] = {.time = now, .heard = heard_, .lost = lost_};
  }

  /// The probability that the network loses all messages that a living role sends in this silence;
  /// 1 if no other role was heard since the role's last message.
  /// @param silence the part of the time since the role's last message in which this process could
  ///     hear
  double ChanceOfLife(Role role, Duration silence) const {
    const Mark& last = since_[static_cast<std::size_t>(role)];
    const auto others =
        std::ranges::count_if(since_, [&](const Mark& mark) { return mark.time > last.time; });
    if (others == 0) return 1;
    const double signs = Seconds(silence) / Seconds(every_);
    const auto heard = static_cast<double>(heard_ - last.heard);
    const auto lost = static_cast<double>(lost_ - last.lost);
    // The share of lost messages. It is the larger of two estimates. The first compares the heard
    // messages with the least number of messages that the other roles have sent. The second uses
    // the number of messages that are known to be lost.
    const double share_lost =
        std::max(1 - heard / (static_cast<double>(others) * signs), lost / (heard + lost));
    return std::pow(std::clamp(share_lost, 0.0, 1.0), signs);
  }

 private:
  /// When a role was last heard, and how many messages had been heard and lost by then.
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
