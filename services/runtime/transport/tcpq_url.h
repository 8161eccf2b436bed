// The address of a tcpq relay. LCM resolves no host names, and does not notice that inet_aton()
// fails for a name. So a name silently becomes 0.0.0.0, which is this machine. Fogline therefore
// resolves names before LCM's programs see them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

namespace fogline::runtime::tcpq {

inline constexpr std::uint16_t kDefaultPort = 7700;  // the default of LCM

/// An IPv4 address in numbers and a port.
struct Endpoint {
  std::string address;
  std::uint16_t port;

  std::string ToString() const { return address + ":" + std::to_string(port); }
  /// The URL in the form that LCM's programs take.
  std::string Url() const { return "tcpq://" + ToString(); }
};

/// Reads "HOST", "HOST:PORT" or "" (127.0.0.1), where HOST is a name or an IPv4 address.
/// @throws InputError that names `what` if there is no such host or port
Endpoint Resolve(std::string_view host_and_port, std::string_view what);

/// Resolve() for an address on which a process of this machine will listen. @throws InputError also
/// if the kernel says that this machine has no such address
Endpoint ResolveOwn(std::string_view host_and_port, std::string_view what);

/// Whether this text for Resolve() names a port.
bool HasPort(std::string_view host_and_port);

/// Throws an error that says why a process cannot listen at `place`.
/// @throws InputError that names `what` if the port is busy, if this user may not use the port, or
///     if this machine does not have the address; std::runtime_error for other reasons, and for
///     port 0 (any free port)
[[noreturn]] void ThrowCannotListen(const Endpoint& place, std::string_view what,
                                    std::error_code why);

/// Checks that a process of this machine can listen at `place` now. Another program may take the
/// port afterwards. @throws as ThrowCannotListen()
void RequireFree(const Endpoint& place, std::string_view what);

/// Resolve() for a URL, which is "tcpq://" and a text for Resolve(). @throws InputError also for
/// port 0
Endpoint ResolveUrl(std::string_view url);

}  // namespace fogline::runtime::tcpq
