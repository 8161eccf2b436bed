// Whether a process that is not heard of is silent, or the network loses what it says. All speak in
// the same rhythm over the same network, so how much of the others is heard tells how likely it is
// that nothing of this one came through.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "services/graph.h"
#include "services/runtime/clock.h"

namespace fogline {

class SignsOfLife {
 public:
  /// @param every how often each process says something, at least
  explicit SignsOfLife(Duration every) : every_(every) {}

  /// A role has said something; so many messages of it before that were not heard.
  void Heard(Role role, std::int64_t lost, TimePoint now) {
    ++heard_;
    lost_ += std::max<std::int64_t>(0, lost);
    Since(role, now);
  }
  /// The role can be heard from now on.
  void Since(Role role, TimePoint now) {
    since_[static_cast<std::size_t>(role)] = {.time = now, .heard = heard_, .lost = lost_};
  }

  /// How likely it is that the role has spoken all the time in which it was not heard, such as that
  /// it is alive: 1 if nobody was heard.
  /// @param silence time since the last word in which it could have been heard
  double ChanceOfLife(Role role, Duration silence) const {
    const Mark& last = since_[static_cast<std::size_t>(role)];
    const auto others =
        std::ranges::count_if(since_, [&](const Mark& mark) { return mark.time > last.time; });
    if (others == 0) return 1;
    const double signs = Seconds(silence) / Seconds(every_);
    const auto heard = static_cast<double>(heard_ - last.heard);
    const auto lost = static_cast<double>(lost_ - last.lost);
    // Of what was said at least, and of what is known to have been said.
    const double share_lost =
        std::max(1 - heard / (static_cast<double>(others) * signs), lost / (heard + lost));
    return std::pow(std::clamp(share_lost, 0.0, 1.0), signs);
  }

 private:
  /// When a role was heard last, and how much had been heard and lost by then.
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

}  // namespace fogline
