#include "services/runtime/transport/lcm_sockets.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/core.h>

#include "common/process/console.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/transport/multicast_route.h"

namespace fogline::runtime {
namespace {

thread_local LcmSockets* in_charge = nullptr;

int Connect(int socket, const sockaddr* address, socklen_t size) {
  return static_cast<int>(syscall(SYS_connect, socket, address, size));
}
int SetOption(int socket, int level, int name, const void* value, socklen_t size) {
  return static_cast<int>(syscall(SYS_setsockopt, socket, level, name, value, size));
}

in_addr Loopback() { return {.s_addr = htonl(INADDR_LOOPBACK)}; }

/// The index of an interface; 0 if there is no such interface.
int InterfaceIndex(const std::string& interface) {
  return static_cast<int>(if_nametoindex(interface.c_str()));
}

}  // namespace

LcmSockets::LcmSockets(Reach reach) : reach_(reach) { in_charge = this; }

LcmSockets::~LcmSockets() { in_charge = nullptr; }

int LcmSockets::OnConnect(int socket, const sockaddr* address, socklen_t size) const {
  const int result = Connect(socket, address, size);
  // LCM connects a socket only to find out whether there is a route. kLoopback needs no route, so
  // with kLoopback this call always succeeds.
  return reach_ == Reach::kLoopback ? 0 : result;
}

int LcmSockets::OnOption(int socket, int level, int name, const void* value, socklen_t size) const {
  // LCM joins the group even if it only sends. Sending needs no membership, so this join is left
  // out.
  if (level == IPPROTO_IP && name == IP_ADD_MEMBERSHIP) return 0;
  const int result = SetOption(socket, level, name, value, size);
  if (reach_ != Reach::kLoopback || level != IPPROTO_IP) return result;
  if (name != IP_MULTICAST_TTL) return result;  // LCM sets this option only on its sending socket
  const in_addr loopback = Loopback();
  return SetOption(socket, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof(loopback));
}

bool JoinOnLoopback(int socket, const in_addr& group) {
  const ip_mreq membership{.imr_multiaddr = group, .imr_interface = Loopback()};
  return SetOption(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0 ||
         errno == EADDRINUSE;
}

bool LoopbackIsUp() { return RouteError("127.0.0.1").empty(); }

LcmSockets::Reach ReachOf(const std::string& url) {
  const auto address = ParseMulticastUrl(url);
  return address && address->ttl == 0 && LoopbackIsUp() ? LcmSockets::Reach::kLoopback
                                                        : LcmSockets::Reach::kRoute;
}

GroupMembership::GroupMembership(int socket, const std::string& url)
    : socket_(socket), group_(GroupOf(url).value_or("")) {
  inet_pton(AF_INET, group_.c_str(), &joined_.imr_multiaddr);
  joined_.imr_ifindex = InterfaceIndex(RouteInterface(KernelTable("/proc/net/route"), group_));
}

void GroupMembership::Renew() {
  const std::string interface = RouteInterface(KernelTable("/proc/net/route"), group_);
  const int index = InterfaceIndex(interface);
  if (index == 0) return;  // there is no route
  if (index == joined_.imr_ifindex && HasGroup(KernelTable("/proc/net/igmp"), interface, group_)) {
    return;
  }
  // A socket remembers a group even after its interface has lost the group. So the socket must
  // leave the group before it can join again.
  SetOption(socket_, IPPROTO_IP, IP_DROP_MEMBERSHIP, &joined_, sizeof(joined_));
  joined_.imr_ifindex = index;
  std::string trouble;
  if (SetOption(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &joined_, sizeof(joined_)) != 0) {
    trouble =
        fmt::format("warning: cannot hear {} on {}: {}", group_, interface, std::strerror(errno));
  }
  if (!trouble.empty() && trouble != trouble_) Notice(trouble);
  trouble_ = std::move(trouble);
}

}  // namespace fogline::runtime

// These functions replace the functions of the C library with the same names, also in LCM's code.
extern "C" int connect(int socket, const sockaddr* address, socklen_t size) {
  return fogline::runtime::in_charge != nullptr
             ? fogline::runtime::in_charge->OnConnect(socket, address, size)
             : fogline::runtime::Connect(socket, address, size);
}
extern "C" int setsockopt(int socket, int level, int name, const void* value,
                          socklen_t size) noexcept {
  return fogline::runtime::in_charge != nullptr
             ? fogline::runtime::in_charge->OnOption(socket, level, name, value, size)
             : fogline::runtime::SetOption(socket, level, name, value, size);
}
