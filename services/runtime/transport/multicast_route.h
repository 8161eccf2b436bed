// Checks whether this machine has a route for multicast. Fogline makes this check before it calls
// LCM. Without a route, LCM's error message names an address that the user has not given, and a
// command that few systems have.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fogline::runtime {

/// A command that lets LCM work on a machine without a network. Needs root.
inline constexpr std::string_view kLoopbackRoute = "ip route add 239.0.0.0/8 dev lo";

/// The multicast group of a udpm:// or mpudpm:// URL, LCM's own group if the URL names no group;
/// nullopt for other URLs.
std::optional<std::string> GroupOf(std::string_view url);

/// Whether an IPv4 address is the address of a multicast group.
bool IsMulticast(const std::string& address);

/// Advice for a udpm:// or mpudpm:// URL that has the address of one machine: the URL to write
/// instead.
std::string InPlaceOfUnicast(std::string_view url);

/// The kernel's error if it has no route to an IPv4 address; "" if it has a route.
std::string RouteError(const std::string& address);

/// The interface of the route to an IPv4 address; "" if there is no such route or `address` is not
/// an IPv4 address.
/// @param table in the form of /proc/net/route; the longest prefix wins, then the lowest metric
std::string RouteInterface(std::string_view table, const std::string& address);

/// A table of the kernel, such as /proc/net/route; "" if it cannot be read.
std::string KernelTable(const char* file);

/// Whether an interface receives a multicast group, according to `table`.
/// @param table in the form of /proc/net/igmp
bool HasGroup(std::string_view table, std::string_view interface, const std::string& group);

/// Why a udpm:// or mpudpm:// URL cannot be opened, and what the user can do; "" if no reason is
/// known.
std::string WhyNoMulticast(std::string_view url);

}  // namespace fogline::runtime
