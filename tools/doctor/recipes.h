// Lines of shell that carry out a remedy. The effect of most recipes remains after a restart of the
// machine. The title of a recipe says if its effect does not remain.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fogline::doctor {

struct Recipe {
  std::string title;   // purpose of the recipe, such as "systemd-networkd"
  std::string script;  // lines of sh for root, ready to paste, each with its line feed
};

/// Recipes that add the multicast route over an interface.
std::vector<Recipe> RouteRecipes(const std::string& interface);

/// Recipes that let a firewall of nftables pass a multicast group and port, and IGMP. The second
/// recipe makes the rules permanent that the first recipe has inserted.
std::vector<Recipe> FirewallRecipes(const std::string& group, std::uint16_t port);

/// Recipes that permit real-time priority and locked memory for a user. @param programs folder of
/// the roles' programs
std::vector<Recipe> PriorityRecipes(const std::string& user, const std::string& programs);

/// The interface that probably leads to other machines. This is the interface of the default route,
/// or else the first interface that is up and is not a loopback; "INTERFACE" if there is neither.
std::string InterfaceToOthers();

}  // namespace fogline::doctor
