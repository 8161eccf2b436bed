// Decides where a role looks for a run if its command line names no network and no run. The role
// looks at the meeting address (lcm_url.h), and at the network of each run that is announced there
// and waits for the role.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "common/own_pauses.h"
#include "services/runtime/discovery/beacon.h"

namespace fogline::runtime {

class RunSeeker {
 public:
  /// @throws InputError like Bus()
  RunSeeker(Role role, const std::string& meeting_url)
      : role_(role), listener_(meeting_url), began_(Clock::now()), pauses_(began_) {}

  /// Looks for a run to join. Call this function while the role has no run, or while its runner is
  /// silent.
  /// @return the run to join now: the newest run that waits for this role and was not tried in
  ///     vain; nullopt if there is no such run, or if the role already tries to join a run
  std::optional<Announcement> Look(TimePoint now);

  /// Whether the role has gone to the network of an announced run.
  bool Tries() const { return tried_.has_value(); }
  /// Whether the try to join an announced run has failed: the run is over, or the try has lasted
  /// for longer than kSilentLimit. After a failed try the role goes back to the meeting address.
  /// Call this function while the role has not joined.
  bool InVain(TimePoint now);
  /// Gives up the run that was tried last: Look() does not return this run for the time kTryAgain.
  /// In this time the role can join a run at the meeting address itself. The exclusion ends earlier
  /// if an announcement says that the run does not wait for the role, because another process has
  /// the role. If a later announcement says that the run waits again, the role has become free, and
  /// a new try can succeed.
  void GiveUp(TimePoint now);
  /// From now on, Look() does not return this run on this network, because the role already takes
  /// part in it. A run that is resumed on another network is returned.
  void Ignore(std::int64_t run_id, std::string_view url) {
    own_ = {.run_id = run_id, .url = std::string(url)};
  }
  /// Notes that the role has left this run and is still at the run's network.
  void Stay(std::int64_t run_id, TimePoint now) { tried_ = {.run_id = run_id, .at = now}; }

 private:
  // After this time InVain() is true. A runner that waits for roles sends 20 messages a second. We
  // assume that a busy machine or a bad network delays these messages by less than this time.
  static constexpr Duration kSilentLimit = milliseconds(5000);
  // After this time a run that was tried in vain is tried again. A busy machine may have delayed
  // the run, or the port of the run's network may have been in use by another program for a moment.
  static constexpr Duration kTryAgain = milliseconds(5000);
  // The largest size of in_vain_. With this limit, invented runs cannot fill the memory.
  static constexpr std::size_t kMaxInVain = 64;

  struct Try {
    std::int64_t run_id;
    TimePoint at;
  };
  struct OwnRun {
    std::int64_t run_id;
    std::string url;
  };
  bool IsOwn(const Announcement& run) const;

  Role role_;
  BeaconListener listener_;
  TimePoint began_;
  OwnPauses pauses_;
  std::optional<Try> tried_;
  std::optional<OwnRun> own_;  // the run in which the role takes part
  std::deque<Try> in_vain_;
};

}  // namespace fogline::runtime
