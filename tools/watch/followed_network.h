// The network that a program observes: the network of its URL. Without a URL the program also
// observes the network of a run that is announced on this machine (Following). The program sends
// nothing.
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

/// Which announced run a program follows. `kNewestRun`: always the newest run. `kFirstRun`: the run
/// that was the newest when the program first found a run; the program stays with this run, also
/// after the end of the run.
enum class Following { kNothing, kNewestRun, kFirstRun };

class FollowedNetwork {
 public:
  /// The caller must call Handle() at least this often, because after very many messages poll() may
  /// not report the messages that still wait.
  static constexpr Duration kLookEvery = milliseconds(50);

  /// @param watcher gets every message except those on the channels of IsHousekeeping()
  /// @throws InputError, std::runtime_error like Bus()
  FollowedNetwork(std::string url, Following following, runtime::Bus::Watcher watcher);

  /// Handles messages that have come, and looks for announced runs.
  /// @throws std::runtime_error if the network of the URL is lost
  void Handle(TimePoint now);

  /// Closes the network of the URL and opens it again, if LCM's library receives its messages
  /// (Bus::LcmReceives()) and has stored too many channel names. Meanwhile, for some milliseconds,
  /// the watcher misses messages.
  /// @param unknown number of messages so far on channels with unknown names
  void ForgetNames(std::int64_t unknown);

  /// The descriptors to wait for; -1 for a network that is not open. They are valid until the next
  /// Handle() or ForgetNames() that changes generation().
  std::array<int, 2> descriptors() const {
    return {network_->bus.fd(), followed_ && !followed_->lost ? followed_->bus.fd() : -1};
  }
  /// A number that changes when a network is opened or closed, or when its relay is lost or comes
  /// back. A descriptor may then have the same number, but belong to another file.
  std::int64_t generation() const { return generation_; }

  /// The URL of the followed run's network; without a followed run, the given URL.
  const std::string& url() const { return followed_ ? followed_->bus.url() : network_->bus.url(); }
  /// The roles that wait for a run on the given network, or on this machine if no URL is given.
  std::vector<runtime::WaitingRole> waiting(TimePoint now) const { return waiting_.Current(now); }
  bool follows() const { return listener_.has_value(); }
  bool followed() const { return followed_.has_value(); }
  /// The announced runs. The followed run comes first. With `kFirstRun`, the list contains the
  /// followed run also after its end.
  const std::vector<runtime::Announcement>& runs() const { return runs_; }

  /// The senders, and how many messages of each sender were lost.
  SendersView ViewSenders(TimePoint now) const { return senders_.View(now); }
  /// Whether packets have numbers by which a loss is found. Packets of a relay have no numbers.
  bool numbered() const { return network_->tap || (followed_ && followed_->tap); }
  /// The reason why packets with numbers cannot be counted; "" if they are counted.
  const std::string& tap_trouble() const { return tap_trouble_; }

 private:
  struct Network {
    Network(const std::string& url, const runtime::Bus::Watcher& watcher);
    /// @return whether a descriptor may now belong to another file
    bool Drain(TimePoint now);

    runtime::Bus bus;
    std::unique_ptr<PacketTap> tap;  // nullptr if packets have no numbers
    std::int64_t replaced = 0;       // bus.replaced() at the last Drain()
    bool lost = false;               // whether the relay of this network has ended
  };

  void Open();
  void OpenFollowed();
  /// @return nullptr if the packets have no numbers, or cannot be counted
  std::unique_ptr<PacketTap> Tap(const std::string& url);
  void Follow(TimePoint now);
  void DrainFollowed(TimePoint now);
  void CloseFollowed();
  void Leave();

  std::string url_;
  Following following_;
  runtime::Bus::Watcher watcher_;
  runtime::WaitingRoles waiting_;
  Senders senders_;
  std::optional<Network> network_;
  std::int64_t names_ = 0;                           // unknown names when network_ was opened
  std::optional<runtime::BeaconListener> listener_;  // set if announced runs are to be followed
  std::vector<runtime::Announcement> runs_;
  std::optional<runtime::Announcement> run_;  // the followed run
  std::optional<Network> followed_;           // the network of this run, if it is not network_
  std::vector<std::int64_t> unreachable_;     // ids of runs whose networks could not be opened
  TimePoint follow_at_{};
  std::string tap_trouble_;
  std::int64_t generation_ = 0;
};

}  // namespace fogline::watch
