// The runs that announce themselves at the meeting address. Programs that were given no URL listen
// at this address. This class has no subscription and no clock: its caller passes messages and
// times to it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/clock.h"
#include "fogline/beacon_t.hpp"
#include "services/graph.h"
#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

/// The channel of beacon_t. The channel is not in kGraph, because no run uses the channel.
inline constexpr std::string_view kBeaconChannel = "FOGLINE_BEACON";
/// The interval at which a run announces itself. The interval is short, so that a person who starts
/// a program finds the run without a long wait.
inline constexpr Duration kBeaconEvery = milliseconds(500);

/// A run as its beacon describes it. Its texts are safe to print.
struct Announcement {
  std::int64_t run_id = 0;
  std::int64_t began_us = 0;  // wall clock, since 1970
  std::string url;
  std::string scenario;  // title; UTF-8
  std::string host;
  std::int32_t pid = 0;
  std::vector<Role> awaited;  // roles that the run waits for, in the order of kRoles

  bool Awaits(Role role) const;
  /// Returns a text such as "run 123 at udpm://239.255.76.67:7700?ttl=0, scenario A box of fog,
  /// announced by pid 4711 on lab1; it waits for the driver". The text is ASCII: '?' stands for
  /// other characters of the title.
  std::string Text() const;
};

/// All runs that are announced. LCM has no access control, so any program can send a beacon. This
/// class therefore refuses a beacon that no runner of this machine can have sent, and limits the
/// number of runs that it remembers.
class Announcements {
 public:
  /// @param host name of this machine; a beacon does not leave its machine, so a beacon with
  ///     another host name is refused
  explicit Announcements(std::string host) : host_(std::move(host)) {}

  /// Evaluates the bytes of a beacon. @param wall_us wall clock, microseconds since 1970
  void Hear(Bytes bytes, TimePoint now, std::int64_t wall_us);

  /// The runs that have not ended, the newest first.
  std::vector<Announcement> Current(TimePoint now) const;

  /// How many beacons were refused.
  std::int64_t refused() const { return refused_; }

  /// A run counts as ended if its last beacon is older than kGone. Six beacons are due in this
  /// time.
  static constexpr Duration kGone = 6 * kBeaconEvery;
  /// The largest number of runs that are remembered. A further run replaces the run with the fewest
  /// beacons. So invented runs with one beacon each do not displace a run that continues to
  /// announce itself.
  static constexpr std::size_t kMax = 256;
  /// The longest title, in bytes.
  static constexpr std::size_t kMaxTitle = 200;

 private:
  struct Entry {
    Announcement announcement;
    TimePoint heard;
    std::int64_t times = 0;
  };
  bool Take(Bytes bytes, TimePoint now, std::int64_t wall_us);
  void Keep(Announcement announcement, TimePoint now);

  std::string host_;
  std::vector<Entry> entries_;  // in the order of their first beacons
  std::int64_t refused_ = 0;
};

}  // namespace fogline::runtime
