#include "services/runtime/transport/tcpq_url.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/parse_number.h"
#include "services/runtime/transport/multicast_route.h"

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

/// Calls `call`, such as bind(), with a new socket of this type and with the address of `place`.
/// @return errno if the call fails; 0 if it succeeds, or if no socket can be opened
template <class Call>
int ErrorOf(int type, const Endpoint& place, const Call& call) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(place.port);
  inet_pton(AF_INET, place.address.c_str(), &address.sin_addr);
  const int probe = socket(AF_INET, type | SOCK_CLOEXEC, 0);
  if (probe < 0) return 0;
  const bool fails = call(probe, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0;
  const int error = fails ? errno : 0;
  close(probe);
  return error;
}

/// Listens as a server does: SO_REUSEADDR allows a port that only closed connections still use.
int BindAndListen(int socket, const sockaddr* address, socklen_t size) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  return bind(socket, address, size) != 0 ? -1 : listen(socket, 1);
}

/// Whether an IPv4 address belongs to this machine, and clients can connect to it. bind() fails if
/// the address does not belong to this machine. But bind() accepts multicast and broadcast
/// addresses, to which no client can connect. connect() of a UDP socket sends no packet, and fails
/// with EACCES for a broadcast address. But without a route, connect() does not report this error
/// for 255.255.255.255. So this function compares the address with 255.255.255.255 itself.
bool IsOwn(const std::string& address) {
  return !IsMulticast(address) && address != "255.255.255.255" &&
         ErrorOf(SOCK_STREAM, {address, 0}, bind) != EADDRNOTAVAIL &&
         ErrorOf(SOCK_DGRAM, {address, 0}, connect) != EACCES;
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

Endpoint ResolveOwn(std::string_view host_and_port, std::string_view what) {
  Endpoint endpoint = Resolve(host_and_port, what);
  if (!IsOwn(endpoint.address)) {
    const std::string host(host_and_port.substr(0, host_and_port.find(':')));
    throw InputError(fmt::format(
        "error: {}: {} is no address of this machine (`ip address` lists them)", what,
        host == endpoint.address ? host : fmt::format("\"{}\" ({})", host, endpoint.address)));
  }
  return endpoint;
}

bool HasPort(std::string_view host_and_port) {
  return host_and_port.find(':') != std::string_view::npos;
}

void ThrowCannotListen(const Endpoint& place, std::string_view what, std::error_code why) {
  const std::string words = fmt::format("cannot listen on {}: {}", place.ToString(), why.message());
  const bool of_port = why == std::errc::address_in_use || why == std::errc::permission_denied ||
                       why == std::errc::address_not_available;
  if (place.port == 0 || !of_port) throw std::runtime_error(words);
  throw InputError(fmt::format("error: {}: {}", what, words));
}

void RequireFree(const Endpoint& place, std::string_view what) {
  const int error = ErrorOf(SOCK_STREAM, place, BindAndListen);
  if (error != 0) ThrowCannotListen(place, what, {error, std::generic_category()});
}

Endpoint ResolveUrl(std::string_view url) {
  const Endpoint endpoint = Resolve(url.substr(kScheme.size()), url);
  if (endpoint.port == 0)
    throw InputError(fmt::format("error: {}: no process can listen on port 0", url));
  return endpoint;
}

}  // namespace fogline::runtime::tcpq
