// The address of a tcpq relay. LCM resolves no host names: its test of what inet_aton() returns
// cannot fail, so a name silently becomes 0.0.0.0, this machine. So Fogline resolves names before
// LCM's programs see them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fogline::runtime::tcpq {

inline constexpr std::uint16_t kDefaultPort = 7700;  // LCM's

/// An IPv4 address in numbers and a port.
struct Endpoint {
  std::string address;
  std::uint16_t port;

  std::string ToString() const { return address + ":" + std::to_string(port); }
  /// The URL in the form that LCM's programs take.
  std::string Url() const { return "tcpq://" + ToString(); }
};

/// "HOST", "HOST:PORT" or "" (127.0.0.1), where HOST is a name or an IPv4 address.
/// @throws InputError that begins with `what` if there is no such host or port
Endpoint Resolve(std::string_view host_and_port, std::string_view what);

/// The same for a URL: such a text after "tcpq://".
Endpoint ResolveUrl(std::string_view url);

}  // namespace fogline::runtime::tcpq
