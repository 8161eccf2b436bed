// A runner announces its run at the address where programs without a URL listen (lcm_url.h,
// MeetingUrl()). So these programs find the run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fogline/beacon_t.hpp"
#include "services/runtime/discovery/announcements.h"
#include "services/runtime/discovery/meeting_sender.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/load_shedder.h"

namespace fogline::runtime {

/// Sends the beacons of a run. If a beacon cannot be sent, the run goes on without it. A beacon
/// stays on this machine (ttl=0), even if the meeting address has another ttl. A beacon is never
/// signed, even if the run has a key. A signature is not necessary: a beacon tells only where the
/// run is, and the signatures of the run's own messages are verified.
class Beacon {
 public:
  /// Makes the beacons of `run`. Nothing is sent in three cases:
  /// - The run is at the meeting address itself.
  /// - Programs must not follow a beacon to the run's URL (MayBeAnnounced()).
  /// - The meeting address is not a multicast group, or has no route.
  /// @param run the run; the constructor itself determines host, pid and began_us
  explicit Beacon(Announcement run);
  /// Announces that the run is over.
  ~Beacon();
  Beacon(const Beacon&) = delete;
  Beacon& operator=(const Beacon&) = delete;

  /// Whether the next beacon is due.
  bool Due(TimePoint now) const { return sender_.is_open() && now >= due_; }
  /// Sends a beacon. @param awaited roles that the run waits for now
  void Send(TimePoint now, const std::vector<Role>& awaited);

 private:
  void Publish();

  beacon_t beacon_{};
  MeetingSender sender_;
  TimePoint due_{};
  std::vector<std::uint8_t> buffer_;
};

/// Receives beacons, for a program that looks for a run.
class BeaconListener {
 public:
  /// Receives nothing if the address is not a multicast group.
  explicit BeaconListener(const std::string& meeting_url);

  /// Reads the beacons that have come.
  void Look();
  /// The runs that have not ended, the newest first.
  std::vector<Announcement> Runs() const { return announcements_.Current(Clock::now()); }
  std::int64_t refused() const { return announcements_.refused(); }
  /// Descriptor that is readable when a beacon has come; -1 if the listener receives nothing.
  int fd() const { return bus_ ? bus_->fd() : -1; }

 private:
  std::optional<Bus> bus_;
  Announcements announcements_;
  // The limit in beacons per second. The runs of one machine send far fewer.
  LoadShedder shedder_{3000};
};

}  // namespace fogline::runtime
