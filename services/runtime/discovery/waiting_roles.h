// Roles that wait for a run. A role without a run sends its STATUS with run id 0 on the channel
// kWaitingChannel. So programs can show which roles wait, even before any run begins.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/clock.h"
#include "fogline/status_t.hpp"
#include "services/runtime/discovery/meeting_sender.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

/// The channel on which a waiting role sends its STATUS. The channel is not in kGraph, because no
/// run uses it. In this STATUS, waiting_for is the URL of the network on which the role waits, and
/// waiting_ms is the time for which the role has waited.
inline constexpr std::string_view kWaitingChannel = "FOGLINE_WAITING";
/// The interval at which a waiting role sends its STATUS.
inline constexpr Duration kWaitingEvery = milliseconds(500);

/// Sends the STATUS of a waiting role on the network on which the role waits. Sends it also to the
/// meeting address (MeetingSender), where programs without a URL listen.
class WaitingNotice {
 public:
  bool Due(TimePoint now) const { return now >= due_; }
  /// @param status the role's STATUS @param since when the wait began
  void Send(status_t status, Bus& bus, TimePoint since, TimePoint now);

 private:
  TimePoint due_{};
  std::optional<MeetingSender> meeting_;
  std::string url_;  // the network that the messages of meeting_ name
  std::vector<std::uint8_t> buffer_;
};

/// A role that waits. Its texts are safe to print.
struct WaitingRole {
  std::string role;
  std::string host;
  std::int32_t pid = 0;
  std::int64_t instance = 0;
  std::string version;
  std::string url;
  double waiting_s = 0;
  bool same_types = true;  // whether the role has the message types of this program

  /// Returns a text such as "driver waits on udpm://239.255.76.67:7700?ttl=1: pid 4711 on lab2,
  /// version 0.1.0".
  std::string Text() const;
};

/// The roles that have said that they wait. The number of remembered roles is limited, because LCM
/// has no access control.
class WaitingRoles {
 public:
  void Hear(Bytes bytes, TimePoint now);

  /// The roles that still wait, sorted by role (in the order of kRoles), host and process.
  std::vector<WaitingRole> Current(TimePoint now) const;
  /// The number of messages that are not a valid STATUS of this build.
  std::int64_t undecodable() const { return undecodable_; }

  /// A role counts as gone if its last message is older than kGone. Six messages are due in this
  /// time.
  static constexpr Duration kGone = 6 * kWaitingEvery;
  /// The largest number of roles that are remembered. A further role replaces the role that has
  /// been silent for the longest time.
  static constexpr std::size_t kMax = 64;

 private:
  struct Entry {
    WaitingRole role;
    TimePoint heard;
  };
  std::vector<Entry> entries_;
  std::int64_t undecodable_ = 0;
};

}  // namespace fogline::runtime
