// What LCM does with its UDP sockets, which it keeps to itself: they are filtered before anything
// arrives, and a network of this machine alone goes over the loopback interface.
//
// LCM leaves the choice of an interface to the route for the group, even where nothing is to leave
// the machine (ttl=0). Such traffic ends when that interface, its address or its route goes away: a
// cable, a Wi-Fi, a lease. Loopback needs none of that.
#pragma once

#include <linux/filter.h>
#include <netinet/in.h>

#include <string>
#include <vector>

namespace fogline {

/// While it lives, it sees to every UDP socket that LCM opens in this thread. One at a time in a
/// thread.
class LcmSockets {
 public:
  enum class Reach {
    kLoopback,  ///< sends over loopback; hears what is sent there, and over the route if there is
                ///< one
    kRoute,     ///< both as the route to the group leads
  };

  /// @param filter of each socket that receives, from the start; none if it is empty
  LcmSockets(std::vector<sock_filter> filter, Reach reach);
  ~LcmSockets();
  LcmSockets(const LcmSockets&) = delete;
  LcmSockets& operator=(const LcmSockets&) = delete;

  /// Those that receive.
  const std::vector<int>& receiving() const { return receiving_; }
  /// Whether there are such, and the kernel has taken the filter for every one.
  bool filtered() const { return !receiving_.empty() && !refused_; }

  // Called in place of the C library's functions; they return what those would.
  int OnBind(int socket, const sockaddr* address, socklen_t size);
  int OnConnect(int socket, const sockaddr* address, socklen_t size) const;
  int OnOption(int socket, int level, int name, const void* value, socklen_t size) const;

 private:
  std::vector<sock_filter> filter_;
  Reach reach_;
  std::vector<int> receiving_;
  bool refused_ = false;
};

/// Whether loopback is up. Some containers have none.
bool LoopbackIsUp();

/// How far a udpm:// URL reaches: with ttl=0 no further than loopback, where that is up.
LcmSockets::Reach ReachOf(const std::string& url);

/// That sockets are in the group of a udpm:// URL on the interface to which its route leads. With
/// an interface or its last address go its groups, and a route may change.
class GroupMembership {
 public:
  /// @param sockets those that LCM has just had join where the route leads
  GroupMembership(std::vector<int> sockets, const std::string& url);
  /// Joins where the route leads now, if that is another interface or the group has gone there, and
  /// leaves where it was joined before. Says on stderr what is in the way.
  void Renew();

 private:
  std::vector<int> sockets_;
  std::string group_;
  ip_mreqn joined_{};
  std::string trouble_;  // as said last
};

}  // namespace fogline
