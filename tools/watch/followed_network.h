// The network that a program observes: the one of its URL. Without a URL the program also observes
// the network of the newest run that is announced on this machine. It only listens.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/clock.h"
#include "services/runtime/discovery/beacon.h"
#include "services/runtime/discovery/waiting_roles.h"
#include "services/runtime/transport/bus.h"
#include "tools/watch/senders/packet_tap.h"
#include "tools/watch/senders/senders.h"

namespace fogline::watch {

class FollowedNetwork {
 public:
  /// A flood may leave messages that poll() does not report. So call Handle() at least so often.
  static constexpr Duration kLookEvery = milliseconds(50);

  /// @param follows whether to follow announced runs
  /// @param watcher gets every message, except LCM's own and beacons
  /// @throws InputError, std::runtime_error as Bus()
  FollowedNetwork(std::string url, bool follows, runtime::Bus::Watcher watcher);

  /// Handles messages that have come, and looks for announced runs.
  /// @throws std::runtime_error if the network of the URL is lost
  void Handle(TimePoint now);

  /// Closes the network of the URL and opens it again, if LCM receives there (Bus::LcmReceives())
  /// and has too many names. The watcher misses the messages of these milliseconds.
  /// @param unknown messages so far on channels whose names were unknown
  void ForgetNames(std::int64_t unknown);

  /// The descriptors to wait for; -1 for a network that is not open. They are valid until the next
  /// Handle() or ForgetNames() that changes generation().
  std::array<int, 2> descriptors() const {
    return {network_->bus.fd(), followed_ ? followed_->bus.fd() : -1};
  }
  /// Changes when a network was opened or closed, or its relay was lost or has come back. A
  /// descriptor may then have the same number and be another file.
  std::int64_t generation() const { return generation_; }

  /// The network of the followed run, or else the given network.
  const std::string& url() const { return followed_ ? followed_->bus.url() : network_->bus.url(); }
  /// The roles that wait for a run on the given network or, without one, on this machine.
  std::vector<runtime::WaitingRole> waiting(TimePoint now) const { return waiting_.Current(now); }
  bool follows() const { return listener_.has_value(); }
  bool followed() const { return followed_.has_value(); }
  /// The announced runs, the followed one first.
  const std::vector<runtime::Announcement>& runs() const { return runs_; }

  /// The senders, and the messages of each that were lost.
  SendersView ViewSenders(TimePoint now) const { return senders_.View(now); }
  /// Whether packets have numbers, by which a loss is found. Those of a relay have none.
  bool numbered() const { return network_->tap || (followed_ && followed_->tap); }
  /// Why packets that have numbers cannot be counted; "" if they are counted.
  const std::string& tap_trouble() const { return tap_trouble_; }

 private:
  struct Network {
    Network(const std::string& url, const runtime::Bus::Watcher& watcher);
    /// @return whether a descriptor has become another file
    bool Drain(TimePoint now);

    runtime::Bus bus;
    std::unique_ptr<PacketTap> tap;  // nullptr if packets have no numbers
    std::int64_t replaced = 0;       // of the bus
  };

  void Open();
  void OpenFollowed(const runtime::Announcement& run);
  /// @return nullptr if the packets have no numbers, or cannot be counted
  std::unique_ptr<PacketTap> Tap(const std::string& url);
  void Follow(TimePoint now);
  void DrainFollowed(TimePoint now);
  void CloseFollowed();
  void Leave(std::int64_t run_id);

  std::string url_;
  runtime::Bus::Watcher watcher_;
  runtime::WaitingRoles waiting_;
  Senders senders_;
  std::optional<Network> network_;
  std::int64_t names_ = 0;                           // unknown names when network_ was opened
  std::optional<runtime::BeaconListener> listener_;  // set if announced runs are to be followed
  std::vector<runtime::Announcement> runs_;
  std::optional<Network> followed_;        // the network of the followed run
  std::vector<std::int64_t> unreachable_;  // ids of runs
  TimePoint follow_at_{};
  std::string tap_trouble_;
  std::int64_t generation_ = 0;
};

}  // namespace fogline::watch
