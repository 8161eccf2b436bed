#include "tools/doctor/recipes.h"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <fmt/core.h>

#include "services/graph.h"
#include "services/runtime/transport/multicast_route.h"

namespace fogline::doctor {
namespace {

/// Shell lines that add a route for LCM's multicast (239.0.0.0/8) with systemd-networkd.
/// systemd-networkd reads one file for each interface. For the interface lo, the lines write this
/// file. Every other interface already has its file, here called FILE. For such an interface, the
/// lines write the route into a further file, in the folder /etc/systemd/network/FILE.d.
std::string NetworkdScript(const std::string& interface) {
  const std::string route =
      "[Route]\n"
      "Destination=239.0.0.0/8\n"
      "Scope=link\n"
      "END\n"
      "networkctl reload\n";
  if (interface == "lo") {
    return "cat >/etc/systemd/network/10-fogline.network <<'END'\n"
           "[Match]\n"
           "Name=lo\n"
           "\n" +
           route;
  }
  return fmt::format(
      "folder=/etc/systemd/network/$(basename \"$(networkctl --no-pager status {0} |\n"
      "  sed -n 's/.*Network File: *//p')\").d\n"
      "mkdir -p \"$folder\"\n"
      "cat >\"$folder/fogline.conf\" <<'END'\n"
      "{1}"
      "networkctl reconfigure {0}\n",
      interface, route);
}

/// Shell lines that add a route for LCM's multicast with ifupdown. For each interface that comes
/// up, ifupdown calls the scripts of the folder /etc/network/if-up.d.
std::string IfupdownScript(const std::string& interface) {
  return fmt::format(
      "cat >/etc/network/if-up.d/fogline <<'END'\n"
      "#!/bin/sh\n"
      "[ \"$IFACE\" = {0} ] || exit 0\n"
      "ip route replace 239.0.0.0/8 dev {0}\n"
      "END\n"
      "chmod +x /etc/network/if-up.d/fogline\n",
      interface);
}

}  // namespace

std::vector<Recipe> RouteRecipes(const std::string& interface) {
  return {{"until the next start", fmt::format("ip route replace 239.0.0.0/8 dev {}\n", interface)},
          {"systemd-networkd", NetworkdScript(interface)},
          {"ifupdown", IfupdownScript(interface)}};
}

std::vector<Recipe> FirewallRecipes(const std::string& group, std::uint16_t port) {
  // In nftables a packet must pass every chain of its hook, so the lines insert the rules at the
  // beginning of each chain.
  const std::string insert = fmt::format(
      "nft list chains | awk '\n"
      "  $1 == \"table\" {{ table = $2 \" \" $3; ours = $2 == \"inet\" || $2 == \"ip\" }}\n"
      "  $1 == \"chain\" {{ chain = $2 }}\n"
      "  ours && /type filter hook (input|output) / {{\n"
      "    print \"insert rule\", table, chain, \"ip daddr {} udp dport {} accept\"\n"
      "    print \"insert rule\", table, chain, \"ip protocol igmp accept\"\n"
      "  }}' | nft -f -\n",
      group, port);
  return {{"nftables, until the next start", insert},
          {"nftables, to keep it",
           "{ echo 'flush ruleset'; nft list ruleset; } >/etc/nftables.conf\n"
           "systemctl enable nftables\n"}};
}

std::vector<Recipe> PriorityRecipes(const std::string& user, const std::string& programs) {
  std::string roles;
  for (const RoleInfo& info : kRoles) roles += fmt::format(" {}", info.name);
  return {{"for a user; it counts from the next login on",
           fmt::format("cat >/etc/security/limits.d/fogline.conf <<'END'\n"
                       "{0} - rtprio 10\n"
                       "{0} - memlock unlimited\n"
                       "END\n",
                       user)},
          {"for these programs; a role then outlives a killed runner by up to 19 s",
           fmt::format("for role in{}; do\n"
                       "  setcap cap_sys_nice,cap_ipc_lock=ep \"{}/fogline-$role\"\n"
                       "done\n",
                       roles, programs)}};
}

std::string InterfaceToOthers() {
  // 192.0.2.1 is reserved for documentation (RFC 5737), so only a default route leads to this
  // address. RouteInterface() gives the interface of this route.
  const std::string usual =
      runtime::RouteInterface(runtime::KernelTable("/proc/net/route"), "192.0.2.1");
  if (!usual.empty() && usual != "lo") return usual;
  std::string found = "INTERFACE";
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return found;
  for (const ifaddrs* one = interfaces; one != nullptr; one = one->ifa_next) {
    const bool usable = one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET &&
                        (one->ifa_flags & IFF_UP) != 0 && (one->ifa_flags & IFF_LOOPBACK) == 0;
    if (!usable) continue;
    found = one->ifa_name;
    break;
  }
  freeifaddrs(interfaces);
  return found;
}

}  // namespace fogline::doctor
