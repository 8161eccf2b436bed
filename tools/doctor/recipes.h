// Lines of shell that make a remedy last beyond the next start of the machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fogline::doctor {

struct Recipe {
  std::string title;   // for whom it is, such as "systemd-networkd"
  std::string script;  // lines of sh for root, ready to paste, each with its line feed
};

/// The multicast route over an interface.
std::vector<Recipe> RouteRecipes(const std::string& interface);

/// Lets a firewall of nftables pass a multicast group and port, and IGMP.
std::vector<Recipe> FirewallRecipes(const std::string& group, std::uint16_t port);

/// Real-time priority and locked memory for a user. @param programs folder of the roles' programs
std::vector<Recipe> PriorityRecipes(const std::string& user, const std::string& programs);

/// The interface that probably leads to other machines: that of the default route, else the first
/// one that is up and no loopback; "INTERFACE" if there is none.
std::string InterfaceToOthers();

}  // namespace fogline::doctor
