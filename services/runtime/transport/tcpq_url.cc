#include "services/runtime/transport/tcpq_url.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netdb.h>

#include <array>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/parse_number.h"

namespace fogline::runtime::tcpq {
namespace {

constexpr std::string_view kScheme = "tcpq://";

std::uint16_t ParsePort(std::string_view text, std::string_view what) {
  const auto port = ParseNumber<std::uint16_t>(text);
  if (!port) throw InputError(fmt::format("error: {}: \"{}\" is no port (0 to 65535)", what, text));
  return *port;
}

std::string AddressOf(const std::string& host, std::string_view what) {
  // "localhost" is always this machine (RFC 6761, section 6.3), even if /etc/hosts does not say so.
  if (host == "localhost") return "127.0.0.1";
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(host.c_str(), nullptr, &hints, &found); error != 0) {
    throw InputError(
        fmt::format("error: {}: no IPv4 address for \"{}\": {}", what, host, gai_strerror(error)));
  }
  const in_addr address = reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr;
  freeaddrinfo(found);
  std::array<char, INET_ADDRSTRLEN> text{};
  inet_ntop(AF_INET, &address, text.data(), text.size());
  return text.data();
}

}  // namespace

Endpoint Resolve(std::string_view host_and_port, std::string_view what) {
  const std::size_t colon = host_and_port.find(':');
  const std::string host(host_and_port.substr(0, colon));
  Endpoint endpoint{.address = "127.0.0.1", .port = kDefaultPort};
  if (colon != std::string_view::npos) {
    endpoint.port = ParsePort(host_and_port.substr(colon + 1), what);
  }
  if (!host.empty()) endpoint.address = AddressOf(host, what);
  return endpoint;
}

bool IsOfThisMachine(in_addr address) {
  if (ntohl(address.s_addr) >> 24 == IN_LOOPBACKNET) return true;
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return false;
  bool found = false;
  for (const ifaddrs* one = interfaces; one != nullptr && !found; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    found = reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr.s_addr == address.s_addr;
  }
  freeifaddrs(interfaces);
  return found;
}

Endpoint ResolveOwn(std::string_view host_and_port, std::string_view what) {
  Endpoint endpoint = Resolve(host_and_port, what);
  in_addr address{};
  inet_pton(AF_INET, endpoint.address.c_str(), &address);
  if (address.s_addr != htonl(INADDR_ANY) && !IsOfThisMachine(address)) {
    throw InputError(
        fmt::format("error: {}: {} is no address of this machine (`ip address` lists them)", what,
                    endpoint.address));
  }
  return endpoint;
}

Endpoint ResolveUrl(std::string_view url) {
  const Endpoint endpoint = Resolve(url.substr(kScheme.size()), url);
  if (endpoint.port == 0)
    throw InputError(fmt::format("error: {}: no process can listen on port 0", url));
  return endpoint;
}

}  // namespace fogline::runtime::tcpq
