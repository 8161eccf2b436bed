#include "services/runtime/multicast_route.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>

#include <fmt/core.h>

namespace fogline {

std::string WhyNoMulticast(const std::string& url) {
  constexpr std::string_view kProvider = "udpm://";
  if (!url.starts_with(kProvider)) return "";
  const std::string group =
      url.substr(kProvider.size(), url.find_first_of(":?", kProvider.size()) - kProvider.size());
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(1);  // any: nothing is sent
  if (inet_pton(AF_INET, group.c_str(), &address.sin_addr) != 1) return "";
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return "";
  // Connecting a datagram socket chooses a route and does no more.
  const int result = connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  const bool unreachable = result != 0 && errno == ENETUNREACH;
  close(fd);
  if (!unreachable) return "";
  return fmt::format(
      "this machine has no route for multicast to {}; as root: \"ip route add 239.0.0.0/8 dev lo\" "
      "for traffic on this machine alone, or with the network's interface in place of lo",
      group);
}

}  // namespace fogline
