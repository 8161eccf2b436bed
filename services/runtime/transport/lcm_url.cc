#include "services/runtime/transport/lcm_url.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include <fmt/core.h>

#include "common/parse_number.h"
#include "common/text.h"
#include "services/runtime/transport/kernel_limits.h"
#include "services/runtime/transport/multicast_route.h"
#include "services/runtime/transport/tcpq_url.h"

namespace fogline::runtime {
namespace {

constexpr std::string_view kUdpm = "udpm://";
constexpr std::string_view kTcpq = "tcpq://";
constexpr std::uint16_t kLcmPort = 7667;
// The options of a udpm:// URL.
constexpr std::string_view kTtl = "ttl";
constexpr std::string_view kReceiveBuffer = "recv_buf_size";
// The longest URL that may be announced. A URL with all options of LCM takes 60 characters.
constexpr std::size_t kMaxAnnounced = 200;
// The least receive buffer that may be announced, in bytes. With a smaller buffer, a program that
// joins the run would lose most messages of the run.
constexpr int kLeastAnnouncedBuffer = 100'000;

std::optional<in_addr> ParseAddress(std::string_view text) {
  in_addr address{};
  if (inet_pton(AF_INET, std::string(text).c_str(), &address) != 1) return std::nullopt;
  return address;
}

/// Removes the text before `separator`, and the separator, from the front of `text`.
/// @return the text before `separator`
std::string_view TakeUntil(char separator, std::string_view& text) {
  const std::string_view part = text.substr(0, text.find(separator));
  text.remove_prefix(std::min(text.size(), part.size() + 1));
  return part;
}

bool ReadOptions(std::string_view options, MulticastAddress& address) {
  while (!options.empty()) {
    std::string_view value = TakeUntil('&', options);
    const std::string_view name = TakeUntil('=', value);
    const auto number = ParseNumber<int>(value);
    if (!number || *number < 0) return false;
    if (name == kTtl) {
      address.ttl = *number;
    } else if (name == kReceiveBuffer) {
      address.receive_buffer = *number;
    } else {
      return false;
    }
  }
  return true;
}

/// Whether an address belongs to one of this machine's interfaces or to loopback (127.0.0.0/8).
bool IsOfThisMachine(in_addr numeric) {
  if (ntohl(numeric.s_addr) >> 24 == IN_LOOPBACKNET) return true;
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return false;
  bool found = false;
  for (const ifaddrs* one = interfaces; one != nullptr && !found; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    found = reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr.s_addr == numeric.s_addr;
  }
  freeifaddrs(interfaces);
  return found;
}

/// The host and port of a relay in a tcpq:// URL, with LCM's defaults for missing parts.
struct RelayPlace {
  std::string_view host;
  std::optional<std::uint16_t> port;  // nullopt if the port is not a number

  bool operator==(const RelayPlace&) const = default;
};

std::optional<RelayPlace> ParseRelayUrl(std::string_view url) {
  if (!url.starts_with(kTcpq)) return std::nullopt;
  url.remove_prefix(kTcpq.size());
  if (url.empty()) url = "127.0.0.1";
  RelayPlace place{.host = TakeUntil(':', url), .port = tcpq::kDefaultPort};
  if (!url.empty()) place.port = ParseNumber<std::uint16_t>(url);
  return place;
}

bool IsRelayOfThisMachine(std::string_view url) {
  const auto place = ParseRelayUrl(url);
  if (!place || !place->port || *place->port == 0) return false;
  const auto address = ParseAddress(place->host);
  return address && address->s_addr != htonl(INADDR_ANY) && IsOfThisMachine(*address);
}

}  // namespace

std::optional<std::string> UrlOfEnvironment() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  if (url == nullptr || *url == '\0') return std::nullopt;
  return url;
}

std::string NetworkUrl(const std::string& given) {
  if (!given.empty()) return given;
  return UrlOfEnvironment().value_or(std::string(kLcmDefaultUrl));
}

bool IsLcmUrl(std::string_view url) {
  constexpr std::array<std::string_view, 4> kProviders{kUdpm, "mpudpm://", kTcpq, "memq://"};
  return std::ranges::any_of(
      kProviders, [url](std::string_view provider) { return url.starts_with(provider); });
}

std::optional<MulticastAddress> ParseMulticastUrl(std::string_view url) {
  if (!url.starts_with(kUdpm)) return std::nullopt;
  std::string_view options = url.substr(kUdpm.size());
  std::string_view place = TakeUntil('?', options);
  // The default of ttl is 0, in LCM and in Fogline (bus.h).
  MulticastAddress address{
      .group = *GroupOf(url), .port = kLcmPort, .ttl = 0, .receive_buffer = {}};
  TakeUntil(':', place);
  if (!place.empty()) {
    const auto port = ParseNumber<std::uint16_t>(place);
    if (!port) return std::nullopt;
    address.port = *port;
  }
  if (!ParseAddress(address.group) || !ReadOptions(options, address)) return std::nullopt;
  return address;
}

std::string WhyNoOption(std::string_view url) {
  if (!url.starts_with(kUdpm)) return "";
  TakeUntil('?', url);
  while (!url.empty()) {
    std::string_view option = TakeUntil('&', url);
    const std::string_view name = TakeUntil('=', option);
    if (name == kTtl || name == kReceiveBuffer) continue;
    return fmt::format("udpm has no option {}; its options are {} and {}", QuoteShort(name), kTtl,
                       kReceiveBuffer);
  }
  return "";
}

bool SameNetwork(std::string_view a, std::string_view b) {
  const auto one = ParseMulticastUrl(a);
  const auto other = ParseMulticastUrl(b);
  if (one && other) return one->group == other->group && one->port == other->port;
  const auto relay = ParseRelayUrl(a);
  if (relay && relay->port) return relay == ParseRelayUrl(b);
  return TakeUntil('?', a) == TakeUntil('?', b);
}

bool MayBeAnnounced(std::string_view url) {
  if (url.size() > kMaxAnnounced) return false;
  if (url.starts_with(kTcpq)) return url != kTcpq && IsRelayOfThisMachine(url);
  const auto address = ParseMulticastUrl(url);
  if (!address || !IsMulticast(address->group) || address->port == 0) return false;
  const int buffer = address->receive_buffer.value_or(kWideBuffer);
  return address->ttl <= 1 && buffer >= kLeastAnnouncedBuffer && buffer <= kWideBuffer;
}

}  // namespace fogline::runtime
