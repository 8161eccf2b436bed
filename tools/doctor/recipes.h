// Lines of shell that make a remedy permanent, so that it is still there after a restart of the
// machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fogline::doctor {

struct Recipe {
  std::string title;   // what it is for, such as "systemd-networkd"
  std::string script;  // lines of sh for root, ready to paste, each with its line feed
};

/// Recipes that add the multicast route over an interface.
std::vector<Recipe> RouteRecipes(const std::string& interface);

/// Recipes that let a firewall of nftables pass a multicast group and port, and IGMP.
std::vector<Recipe> FirewallRecipes(const std::string& group, std::uint16_t port);

/// Recipes that permit real-time priority and locked memory for a user. @param programs folder of
/// the roles' programs
std::vector<Recipe> PriorityRecipes(const std::string& user, const std::string& programs);

/// The interface that probably leads to other machines. This is the interface of the default route,
/// or else the first interface that is up and is not a loopback; "INTERFACE" if there is neither.
std::string InterfaceToOthers();

}  // namespace fogline::doctor
