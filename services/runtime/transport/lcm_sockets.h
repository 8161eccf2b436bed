// Controls LCM's UDP sockets, to which LCM gives no access. A filter is attached before the first
// datagram arrives. A network that is limited to this machine uses the loopback interface.
//
// LCM uses the interface of the route to the group, even if all messages stay on the machine
// (ttl=0). Traffic of this kind ends when the interface, its address or its route disappears, for
// example when a cable is pulled, a Wi-Fi is lost or a lease ends. The loopback interface does not
// depend on any of these.
#pragma once

#include <linux/filter.h>
#include <netinet/in.h>

#include <string>
#include <vector>

namespace fogline::runtime {

/// While an object of this class exists, it controls every UDP socket that LCM opens in the thread
/// of the object. A thread may have one such object at a time.
class LcmSockets {
 public:
  enum class Reach {
    /// Sends over loopback; receives messages from loopback, and over the route if there is a
    /// route.
    kLoopback,
    kRoute,  ///< sends and receives over the route to the group
  };

  enum class Joins {
    kGroup,  ///< each socket joins the group, as usual in LCM
    /// No socket joins the group. This is enough for messages that are only sent.
    kNothing,
  };

  /// @param filter attached to each receiving socket before its first datagram; empty: no filter
  LcmSockets(std::vector<sock_filter> filter, Reach reach, Joins joins = Joins::kGroup);
  ~LcmSockets();
  LcmSockets(const LcmSockets&) = delete;
  LcmSockets& operator=(const LcmSockets&) = delete;

  /// The sockets that receive.
  const std::vector<int>& receiving() const { return receiving_; }
  /// Whether there are sockets that receive, and the kernel has accepted the filter for each of
  /// them.
  bool filtered() const { return !receiving_.empty() && !refused_; }

  // These functions replace bind(), connect() and setsockopt() of the C library, and return the
  // same values.
  int OnBind(int socket, const sockaddr* address, socklen_t size);
  int OnConnect(int socket, const sockaddr* address, socklen_t size) const;
  int OnOption(int socket, int level, int name, const void* value, socklen_t size);

 private:
  std::vector<sock_filter> filter_;
  Reach reach_;
  Joins joins_;
  std::vector<int> receiving_;
  bool refused_ = false;
};

/// Joins a group on loopback. If the route to the group leads over loopback, an earlier join has
/// already put the socket into the group on loopback. The call then succeeds, too.
/// @return whether the socket is in the group; if it is not, errno says why
bool JoinOnLoopback(int socket, const in_addr& group);

/// Whether loopback is up. In some containers loopback is down.
bool LoopbackIsUp();

/// How far a udpm:// URL reaches: kLoopback if ttl is 0 and loopback is up, otherwise kRoute.
LcmSockets::Reach ReachOf(const std::string& url);

/// Keeps sockets in the group of a udpm:// URL, on the interface to which the route to the group
/// leads. This interface may change. An interface that disappears or loses its last address also
/// loses its groups.
class GroupMembership {
 public:
  /// @param sockets have just joined the group on the interface of the route
  GroupMembership(std::vector<int> sockets, const std::string& url);
  /// Joins the group again, on the interface of the current route, if the route leads to another
  /// interface or the interface has lost the group. The sockets first leave the group on the
  /// interface where they joined it. Prints on stderr why a socket cannot join.
  void Renew();

 private:
  std::vector<int> sockets_;
  std::string group_;
  ip_mreqn joined_{};
  std::string trouble_;  // the last warning
};

}  // namespace fogline::runtime
