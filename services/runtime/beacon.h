// How a run and programs that were given no URL find each other: the runner announces the run at
// the address where such programs listen (lcm_url.h, MeetingUrl()), and they listen for that.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fogline/beacon_t.hpp"
#include "services/runtime/announcements.h"
#include "services/runtime/bus.h"
#include "services/runtime/flood_gate.h"

struct _lcm_t;

namespace fogline {

/// The runner's side. Best effort: where a beacon cannot be sent the run goes on without. It stays
/// on this machine (ttl=0) whatever the meeting address says. It is not signed, with a key or
/// without: it tells where to look, and what is said there is verified.
class Beacon {
 public:
  /// Announces nothing where the run is at the meeting address itself, where no program may go
  /// (MayBeAnnounced()), or where the meeting address is no multicast group.
  /// @param run its host, process and time of beginning are filled in
  explicit Beacon(Announcement run);
  /// Says that the run is over.
  ~Beacon();
  Beacon(const Beacon&) = delete;
  Beacon& operator=(const Beacon&) = delete;

  /// Whether it is time for the next one.
  bool Due(TimePoint now) const { return lcm_ != nullptr && now >= due_; }
  /// @param awaited roles that the run waits for now
  void Send(TimePoint now, const std::vector<Role>& awaited);

 private:
  void Publish();

  beacon_t beacon_{};
  _lcm_t* lcm_ = nullptr;  // LCM's own: it only sends, which takes no thread and no test of itself
  TimePoint due_{};
  std::vector<std::uint8_t> buffer_;
};

/// The side of a program that looks for a run.
class BeaconListener {
 public:
  /// Hears nothing where the address is no multicast group.
  /// @throws InputError as Bus()
  explicit BeaconListener(const std::string& meeting_url);

  /// Takes in what has come.
  void Look();
  /// The runs that go on, the newest first.
  std::vector<Announcement> Runs() const { return announcements_.Current(Clock::now()); }
  std::int64_t refused() const { return announcements_.refused(); }
  /// Readable when there is something to Look() at; -1 if there never is.
  int fd() const { return bus_ ? bus_->fd() : -1; }

 private:
  std::optional<Bus> bus_;
  Announcements announcements_;
  // Many times what the runs of one machine say.
  FloodGate gate_{3000};
};

}  // namespace fogline
