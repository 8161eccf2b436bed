// Finds the deaf roles of a run in real time by their STATUS. A deaf role is alive and sends its
// STATUS. But it has received no message on one of its input channels for a long time, although the
// producer of this channel publishes. A deaf role does not recover by itself. A network that loses
// many messages for a while does not make a role deaf.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/clock.h"
#include "services/graph.h"

namespace fogline {
class status_t;
}  // namespace fogline

namespace fogline::runtime {

struct Deafness {
  std::size_t channel;  // the channel that the role does not receive, an index in kChannels
  Duration missed;      // time without a message while the producer is known to publish
};

/// Returns a text such as "has heard no TRUTH for 2.1 s, although the world has published it".
std::string Text(const Deafness& deaf);

class DeafRoles {
 public:
  /// @param period duration of a step on the wall clock; 0 if the run is not in real time: then no
  ///     role counts as deaf
  explicit DeafRoles(Duration period);

  /// Evaluates an accepted STATUS of the role.
  void Heard(Role role, const status_t& status, TimePoint now);
  /// Forgets everything about the role, because its process is dead.
  void Forget(Role role) { speakers_[static_cast<std::size_t>(role)] = {}; }

  /// Returns the input that the role has missed for the longest time; nullopt if the role is not
  /// deaf.
  std::optional<Deafness> Of(Role role) const { return Missing(role, limit_); }
  /// Like Of(), but for a run that is over. Half of the time limit of Of() is enough, because no
  /// further message will come.
  std::optional<Deafness> AtTheEnd(Role role) const { return Missing(role, limit_ / 2); }

 private:
  /// One input of a role.
  struct Ear {
    Duration age{};
    std::int64_t late = 0;
    Duration missed{};
    Duration unsure{};  // time to add to `missed` when the producer reports a further step
    /// The producer's `ticks` in a STATUS that came after the role had reported the last message;
    /// nullopt until then. An earlier STATUS does not count all messages up to the last one.
    std::optional<std::int64_t> published;
  };
  struct Speaker {
    TimePoint heard{};
    std::int64_t step = -1;
    std::int64_t ticks = 0;  // steps that the role's process has computed; 0 after a restart
    TimePoint advanced{};    // when a STATUS first showed `step`
    std::array<Ear, kNumChannels> ears{};
  };

  std::optional<Deafness> Missing(Role role, Duration limit) const;
  /// Whether the producer has published so many messages that even a bad network would not lose all
  /// of them. Only messages after the last message that the role received are counted. Their number
  /// is enough if it is at least kSureMessages, or at least half of the number of messages that are
  /// due in the time `ear.missed`.
  bool IsSure(const Ear& ear, Role from) const;
  /// Whether the role's STATUS messages show that the role computes one step after another.
  bool Computes(Role role, TimePoint now) const;
  /// Whether `step` is later than any step that the role can have computed by `now`.
  bool IsAheadOf(Role role, std::int64_t step, TimePoint now) const;

  Duration period_;
  Duration limit_;
  std::array<Speaker, kRoles.size()> speakers_{};
};

}  // namespace fogline::runtime
