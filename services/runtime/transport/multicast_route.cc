#include "services/runtime/transport/multicast_route.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fmt/core.h>

#include "common/file.h"
#include "services/runtime/transport/lcm_sockets.h"

namespace fogline::runtime {
namespace {

constexpr std::string_view kDefaultGroup = "239.255.76.67";

std::optional<in_addr> ToAddress(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1) return std::nullopt;
  return address;
}

}  // namespace

std::optional<std::string> GroupOf(std::string_view url) {
  for (const std::string_view provider : {"udpm://", "mpudpm://"}) {
    if (!url.starts_with(provider)) continue;
    const std::string_view rest = url.substr(provider.size());
    const std::string_view group = rest.substr(0, rest.find_first_of(":?"));
    return std::string(group.empty() ? kDefaultGroup : group);
  }
  return std::nullopt;
}

bool IsMulticast(const std::string& address) {
  const auto numeric = ToAddress(address);
  return numeric && IN_MULTICAST(ntohl(numeric->s_addr));
}

std::string InPlaceOfUnicast(std::string_view url) {
  std::string_view place = url.substr(url.find("://") + 3);
  place = place.substr(0, place.find('?'));
  const std::size_t colon = place.find(':');
  const std::string_view port = colon == std::string_view::npos ? ":7667" : place.substr(colon);
  return fmt::format(
      "write udpm://{}{}, the same on every machine; or tcpq://{} with `fogline-relay --listen {}` "
      "on that machine",
      kDefaultGroup, port, place, place);
}

std::string RouteError(const std::string& address) {
  const auto numeric = ToAddress(address);
  if (!numeric) return "not an IPv4 address";
  // connect() of a UDP socket sends no packet: the kernel only looks for the route.
  constexpr std::uint16_t kAnyPort = 7667;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(kAnyPort);
  to.sin_addr = *numeric;
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (probe < 0) {
    ThrowIfExhausted(errno, "cannot look for a route");
    return std::strerror(errno);
  }
  const int result = connect(probe, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  const std::string error = result == 0 ? "" : std::strerror(errno);
  close(probe);
  return error;
}

std::string RouteInterface(std::string_view table, const std::string& address) {
  const auto numeric = ToAddress(address);
  if (!numeric) return "";
  std::istringstream lines{std::string(table)};
  std::string line;
  std::getline(lines, line);  // headings
  std::string best;
  int best_prefix = -1;
  std::uint32_t best_metric = 0;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string interface;
    std::string gateway;
    std::string flags;
    std::string references;
    std::string uses;
    std::uint32_t destination = 0;
    std::uint32_t metric = 0;
    std::uint32_t mask = 0;
    fields >> interface >> std::hex >> destination >> gateway >> flags >> references >> uses >>
        std::dec >> metric >> std::hex >> mask;
    if (!fields || (numeric->s_addr & mask) != destination) continue;
    const int prefix = std::popcount(mask);
    if (prefix < best_prefix || (prefix == best_prefix && metric >= best_metric)) continue;
    best = interface;
    best_prefix = prefix;
    best_metric = metric;
  }
  return best;
}

std::string KernelTable(const char* file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

bool HasGroup(std::string_view table, std::string_view interface, const std::string& group) {
  const auto numeric = ToAddress(group);
  if (!numeric) return false;
  std::istringstream lines{std::string(table)};
  std::string line;
  std::getline(lines, line);  // headings
  bool here = false;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    if (!line.starts_with('\t')) {  // "2	eth0      :     3      V3", and then its groups
      std::string name;
      fields >> name >> name;
      here = name.substr(0, name.find(':')) == interface;  // a long name touches the colon
      continue;
    }
    std::uint32_t address =
        0;  // "				434CFFEF     1 0:00000000		0"
    fields >> std::hex >> address;
    if (here && fields && address == numeric->s_addr) return true;
  }
  return false;
}

std::string WhyNoMulticast(std::string_view url) {
  const auto group = GroupOf(url);
  if (!group || !ToAddress(*group)) return "";
  if (!IsMulticast(*group)) {
    return fmt::format("{} is no multicast group (224.0.0.0 to 239.255.255.255): {}", *group,
                       InPlaceOfUnicast(url));
  }
  if (ReachOf(std::string(url)) == LcmSockets::Reach::kLoopback) return "";
  if (RouteError(*group).empty()) return "";
  return fmt::format(
      "this machine has no route for multicast to {}; as root: \"{}\" for traffic on this machine "
      "only; for other machines replace lo with the network's interface",
      *group, kLoopbackRoute);
}

}  // namespace fogline::runtime
