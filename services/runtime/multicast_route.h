// Whether multicast has a way out of this machine, asked before LCM is: where it has none, LCM
// names an address that nobody has given and a command that few systems have.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fogline {

/// Lets LCM work on a machine without a network. Needs root.
inline constexpr std::string_view kLoopbackRoute = "ip route add 239.0.0.0/8 dev lo";

/// The multicast group of a udpm:// or mpudpm:// URL, LCM's own if the URL names none; none for
/// other URLs.
std::optional<std::string> GroupOf(std::string_view url);

/// Whether an IPv4 address is that of a multicast group.
bool IsMulticast(const std::string& address);

/// What to write in place of a udpm:// or mpudpm:// URL with the address of one machine.
std::string InPlaceOfUnicast(std::string_view url);

/// What the kernel says when asked for a route to an IPv4 address, "" if it has one.
std::string RouteError(const std::string& address);

/// The interface of the route to an IPv4 address in a table as /proc/net/route has it (longest
/// prefix, then lowest metric), "" if there is no such route or `address` is none.
std::string RouteInterface(std::string_view table, const std::string& address);

/// Whether an interface receives a multicast group, by a table as /proc/net/igmp has it.
bool HasGroup(std::string_view table, std::string_view interface, const std::string& group);

/// Why a udpm:// URL cannot be opened, and what to do about it; "" if nothing is known against it.
std::string WhyNoMulticast(std::string_view url);

}  // namespace fogline
