// Which roles of a run in real time are deaf, from their STATUS: processes that live and say how
// they are, and have heard nothing for long of what others publish all the while. Who is deaf for
// long does not recover by itself; a network that loses much for a while makes nobody deaf.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "services/graph.h"
#include "services/runtime/clock.h"

namespace fogline {

class status_t;

struct Deafness {
  std::size_t channel;  // what the role does not hear, a place in kChannels
  Duration missed;      // for how long, as far as its producer is known to have published it
};

/// "has heard no TRUTH for 2.1 s, which the world has published all the while".
std::string Text(const Deafness& deaf);

class DeafRoles {
 public:
  /// @param period of the steps on the wall clock; 0: not in real time, and nobody is deaf
  explicit DeafRoles(Duration period);

  /// A role has said how it is, and its STATUS counts.
  void Heard(Role role, const status_t& status, TimePoint now);
  /// Its process is dead.
  void Forget(Role role) { speakers_[static_cast<std::size_t>(role)] = {}; }

  /// What the role is deaf to: what it has missed for longest, if that is long enough to be sure.
  std::optional<Deafness> Of(Role role) const { return Missing(role, limit_); }
  /// The same of a run that is over, where nothing further will be heard.
  std::optional<Deafness> AtTheEnd(Role role) const { return Missing(role, limit_ / 2); }

 private:
  /// One input of a role.
  struct Ear {
    Duration age{};
    std::int64_t late = 0;
    Duration missed{};
    Duration unsure{};  // since its producer was heard to have computed a step; to be added then
  };
  struct Speaker {
    TimePoint heard{};
    std::int64_t step = -1;
    TimePoint advanced{};  // when it was first heard that it had computed `step`
    std::array<Ear, kNumChannels> ears{};
  };

  std::optional<Deafness> Missing(Role role, Duration limit) const;
  /// The role computes step after step, and that is heard.
  bool Computes(Role role, TimePoint now) const;
  /// A step is further than the role can be that should have computed it.
  bool IsAheadOf(Role role, std::int64_t step, TimePoint now) const;

  Duration period_;
  Duration limit_;
  std::array<Speaker, kRoles.size()> speakers_{};
};

}  // namespace fogline
