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
#include "services/runtime/wire/channel_filter.h"

namespace fogline::runtime {
namespace {

thread_local LcmSockets* in_charge = nullptr;

int Bind(int socket, const sockaddr* address, socklen_t size) {
  return static_cast<int>(syscall(SYS_bind, socket, address, size));
}
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

LcmSockets::LcmSockets(std::vector<sock_filter> filter, Reach reach, Joins joins)
    : filter_(std::move(filter)), reach_(reach), joins_(joins) {
  in_charge = this;
}

LcmSockets::~LcmSockets() { in_charge = nullptr; }

int LcmSockets::OnBind(int socket, const sockaddr* address, socklen_t size) {
  if (!filter_.empty()) refused_ = !AttachFilter(socket, filter_) || refused_;
  receiving_.push_back(socket);
  return Bind(socket, address, size);
}

int LcmSockets::OnConnect(int socket, const sockaddr* address, socklen_t size) const {
  const int result = Connect(socket, address, size);
  // LCM connects a socket only to find out whether there is a route. kLoopback needs no route.
  return reach_ == Reach::kLoopback ? 0 : result;
}

int LcmSockets::OnOption(int socket, int level, int name, const void* value, socklen_t size) {
  const bool join = level == IPPROTO_IP && name == IP_ADD_MEMBERSHIP;
  if (join && joins_ == Joins::kNothing) return 0;
  const int result = SetOption(socket, level, name, value, size);
  if (reach_ != Reach::kLoopback || level != IPPROTO_IP) return result;
  if (name == IP_MULTICAST_TTL) {  // LCM sets this option on the socket that sends
    const in_addr loopback = Loopback();
    return SetOption(socket, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof(loopback));
  }
  if (join && size >= sizeof(ip_mreq)) {
    return JoinOnLoopback(socket, static_cast<const ip_mreq*>(value)->imr_multiaddr) ? 0 : -1;
  }
  return result;
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

GroupMembership::GroupMembership(std::vector<int> sockets, const std::string& url)
    : sockets_(std::move(sockets)), group_(GroupOf(url).value_or("")) {
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
  std::string trouble;
  for (const int socket : sockets_) {
    // A socket remembers a group even after its interface has lost the group. So the socket leaves
    // the group in any case.
    SetOption(socket, IPPROTO_IP, IP_DROP_MEMBERSHIP, &joined_, sizeof(joined_));
    ip_mreqn there = joined_;
    there.imr_ifindex = index;
    if (SetOption(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &there, sizeof(there)) == 0) continue;
    trouble =
        fmt::format("warning: cannot hear {} on {}: {}", group_, interface, std::strerror(errno));
  }
  joined_.imr_ifindex = index;
  if (!trouble.empty() && trouble != trouble_) Notice(trouble);
  trouble_ = std::move(trouble);
}

}  // namespace fogline::runtime

// These functions replace the functions of the C library with the same names, also in LCM's code.
// So a filter is attached before bind(), and no datagram arrives before the filter.
extern "C" int bind(int socket, const sockaddr* address, socklen_t size) noexcept {
  return fogline::runtime::in_charge != nullptr
             ? fogline::runtime::in_charge->OnBind(socket, address, size)
             : fogline::runtime::Bind(socket, address, size);
}
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
