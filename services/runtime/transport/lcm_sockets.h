// Controls the UDP sockets with which LCM sends. LCM gives no access to these sockets, so this code
// replaces connect() and setsockopt() of the C library. A network that is limited to this machine
// uses the loopback interface. Fogline receives with sockets of its own (udpm/group_socket.h).
//
// Without this code, LCM would send through the interface of the route to the group, even if all
// messages stay on the machine (ttl=0). Such traffic ends when the interface, its address or its
// route disappears, for example when a cable is pulled, a Wi-Fi is lost or a lease ends. The
// loopback interface does not depend on any of these.
#pragma once

#include <netinet/in.h>

#include <string>

namespace fogline::runtime {

/// While an object of this class exists, it controls every UDP socket that LCM opens in the thread
/// that made the object. A thread may have one such object at a time.
class LcmSockets {
 public:
  /// How far the messages of a network go.
  enum class Reach {
    /// LCM sends over loopback. A GroupSocket receives from loopback, and over the route if there
    /// is a route.
    kLoopback,
    kRoute,  ///< LCM and the GroupSocket use the route to the group
  };

  explicit LcmSockets(Reach reach);
  ~LcmSockets();
  LcmSockets(const LcmSockets&) = delete;
  LcmSockets& operator=(const LcmSockets&) = delete;

  // These functions replace connect() and setsockopt() of the C library. They return the same
  // values: 0, or -1 with errno.
  int OnConnect(int socket, const sockaddr* address, socklen_t size) const;
  int OnOption(int socket, int level, int name, const void* value, socklen_t size) const;

 private:
  Reach reach_;
};

/// Joins a group on loopback. If the route to the group leads over loopback, an earlier join has
/// already put the socket into the group on loopback. The call then succeeds, too.
/// @return whether the socket is in the group; if it is not, errno says why
bool JoinOnLoopback(int socket, const in_addr& group);

/// Whether loopback is up. In some containers loopback is down.
bool LoopbackIsUp();

/// How far a udpm:// URL reaches: kLoopback if ttl is 0 and loopback is up, otherwise kRoute.
LcmSockets::Reach ReachOf(const std::string& url);

/// Keeps a socket in the group of a udpm:// URL, on the interface to which the route to the group
/// leads. This interface may change. An interface that disappears or loses its last address also
/// loses its groups.
class GroupMembership {
 public:
  /// @param socket a socket that has just joined the group on the interface of the route
  GroupMembership(int socket, const std::string& url);
  /// Checks whether the current route leads to another interface, or whether the interface has lost
  /// the group. If so, the socket leaves the group on its earlier interface, and joins the group on
  /// the interface of the route. If the socket cannot join, prints the reason on stderr. Does
  /// nothing while there is no route.
  void Renew();

 private:
  int socket_;
  std::string group_;
  ip_mreqn joined_{};
  std::string trouble_;  // the last warning
};

}  // namespace fogline::runtime
