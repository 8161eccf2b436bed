#include "services/runtime/transport/udpm/group_socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "services/runtime/transport/kernel_limits.h"
#include "services/runtime/transport/lcm_sockets.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/wire/channel_filter.h"

namespace fogline::runtime {
namespace {

/// @throws std::system_error with errno if the call has not succeeded
void Require(bool succeeded, const std::string& url) {
  if (!succeeded) throw std::system_error(errno, std::generic_category(), url);
}

/// Joins the group on the interface of the route, and on loopback if the messages go over loopback.
/// @return whether the socket has joined the group; if it has not, errno says why
bool Join(int fd, const in_addr& group, const std::string& url) {
  const ip_mreq membership{.imr_multiaddr = group, .imr_interface = {}};
  const bool joined =
      setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0;
  return ReachOf(url) == LcmSockets::Reach::kLoopback ? JoinOnLoopback(fd, group) : joined;
}

}  // namespace

GroupSocket::GroupSocket(const std::string& url, std::vector<sock_filter> filter,
                         std::optional<int> buffer_bytes)
    : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  Require(fd_ >= 0, url);
  try {
    Open(url, std::move(filter), buffer_bytes);
  } catch (...) {
    close(fd_);
    throw;
  }
}

GroupSocket::~GroupSocket() { close(fd_); }

void GroupSocket::Open(const std::string& url, std::vector<sock_filter> filter,
                       std::optional<int> buffer_bytes) {
  const auto network = ParseMulticastUrl(url);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(network.value().port);
  inet_pton(AF_INET, network->group.c_str(), &address.sin_addr);
  if (!filter.empty()) filtered_ = AttachFilter(fd_, std::move(filter));
  const int on = 1;
  for (const int option : {SO_REUSEADDR, SO_REUSEPORT}) {
    Require(setsockopt(fd_, SOL_SOCKET, option, &on, sizeof(on)) == 0, url);
  }
  SetReceiveBuffer(fd_, buffer_bytes.value_or(network->receive_buffer.value_or(kWideBuffer)));
  // A socket that is bound to the group gets no packets of other groups on the same port.
  Require(bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0, url);
  Require(Join(fd_, address.sin_addr, url), url);
}

}  // namespace fogline::runtime
