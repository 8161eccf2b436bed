#include "services/runtime/transport/lcm_url.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/parse_number.h"
#include "common/text.h"
#include "services/runtime/transport/kernel_limits.h"
#include "services/runtime/transport/multicast_route.h"
#include "services/runtime/transport/tcpq_url.h"

namespace fogline::runtime {
namespace {

constexpr std::string_view kUdpm = "udpm://";
constexpr std::string_view kMpudpm = "mpudpm://";
constexpr std::string_view kTcpq = "tcpq://";
constexpr std::string_view kMemq = "memq://";
constexpr int kMostPort = 65535;
// The options of a udpm:// or mpudpm:// URL.
constexpr std::string_view kTtl = "ttl";
constexpr int kMostTtl = 255;  // the field has 8 bits (RFC 791, section 3.1)
constexpr std::string_view kReceiveBuffer = "recv_buf_size";
constexpr std::string_view kPorts = "nports";  // mpudpm: number of ports
// The longest URL that may be announced. A URL with all options of LCM takes 60 characters.
constexpr std::size_t kMaxAnnounced = 200;
// The smallest receive buffer that may be announced, in bytes. With a smaller buffer, a program
// that joins the run would lose most messages of the run.
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

/// LCM's values for the missing parts of a multicast URL. Fogline's default of ttl is also 0
/// (bus.h).
MulticastAddress LcmsDefaults() {
  return {.group = *GroupOf(kUdpm), .port = 7667, .ports = 1, .ttl = 0, .receive_buffer = {}};
}

/// A number of a multicast URL: digits without sign. LCM would read a number with a leading 0 as
/// octal or hexadecimal, so such a number is refused.
std::optional<int> ReadNumber(std::string_view text) {
  if (text.starts_with('-') || (text.size() > 1 && text.starts_with('0'))) return std::nullopt;
  return ParseNumber<int>(text);
}

std::string NoPort(std::string_view text) {
  return fmt::format("{} is no port (1 to {})", QuoteShort(text), kMostPort);
}

/// Reads the part "ADDRESS:PORT" of a multicast URL. @return what is wrong; "" if nothing is wrong
std::string ReadPlace(std::string_view place, MulticastAddress& address) {
  if (place.empty()) return "";
  const std::size_t colon = place.find(':');
  if (colon == 0) return "the address before the port is missing";
  address.group = place.substr(0, colon);
  if (!ParseAddress(address.group)) {
    return fmt::format("{} is no IPv4 address in numbers", QuoteShort(address.group));
  }
  // Without a port after the address, LCM would send to port 0.
  if (colon == std::string_view::npos) return "the port after the address is missing";
  const std::string_view text = place.substr(colon + 1);
  const int port = ReadNumber(text).value_or(0);
  if (port < 1 || port > kMostPort) return NoPort(text);
  address.port = static_cast<std::uint16_t>(port);
  return "";
}

/// Reads one option of a multicast URL. @return what is wrong; "" if nothing is wrong
std::string ReadOption(bool many_ports, std::string_view name, std::string_view value,
                       MulticastAddress& address) {
  if (name != kTtl && name != kReceiveBuffer && !(many_ports && name == kPorts)) {
    return many_ports ? fmt::format("mpudpm has no option {}; its options are {}, {} and {}",
                                    QuoteShort(name), kTtl, kReceiveBuffer, kPorts)
                      : fmt::format("udpm has no option {}; its options are {} and {}",
                                    QuoteShort(name), kTtl, kReceiveBuffer);
  }
  const int least = name == kPorts ? 1 : 0;
  const int most = name == kTtl     ? kMostTtl
                   : name == kPorts ? kMostPort
                                    : std::numeric_limits<int>::max();
  const auto number = ReadNumber(value);
  if (!number || *number < least || *number > most) {
    return fmt::format("{} is {}, which is no number from {} to {}", name, QuoteShort(value), least,
                       most);
  }
  if (name == kTtl) address.ttl = *number;
  if (name == kPorts) address.ports = *number;
  if (name == kReceiveBuffer) address.receive_buffer = *number;
  return "";
}

/// Reads a multicast URL (udpm:// or mpudpm://). @return what is wrong; "" if nothing is wrong
std::string ReadMulticast(std::string_view url, MulticastAddress& address) {
  const bool many_ports = url.starts_with(kMpudpm);
  std::string_view options = url.substr((many_ports ? kMpudpm : kUdpm).size());
  if (url.ends_with('?') || url.ends_with('&')) return "an option is missing at its end";
  std::string why = ReadPlace(TakeUntil('?', options), address);
  while (why.empty() && !options.empty()) {
    std::string_view value = TakeUntil('&', options);
    const std::string_view name = TakeUntil('=', value);
    why = ReadOption(many_ports, name, value, address);
  }
  // With mpudpm, LCM would continue with port 0 after port 65535.
  if (why.empty() && address.port + address.ports - 1 > kMostPort) {
    return fmt::format("the last of {} ports from {} on is above {}", address.ports, address.port,
                       kMostPort);
  }
  return why;
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
  const bool has_port = url.find(':') != std::string_view::npos;
  RelayPlace place{.host = TakeUntil(':', url), .port = tcpq::kDefaultPort};
  if (has_port) place.port = ParseNumber<std::uint16_t>(url);
  return place;
}

/// Whether an address belongs to one of this machine's interfaces or to loopback (127.0.0.0/8). A
/// program may listen on more addresses (tcpq::ResolveOwn()), but clients cannot reach all of them.
bool IsOfThisMachine(in_addr address) {
  if (ntohl(address.s_addr) >> 24 == IN_LOOPBACKNET) return true;
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return false;
  bool found = false;
  for (const ifaddrs* one = interfaces; one != nullptr && !found; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    found = reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr.s_addr == address.s_addr;
  }
  freeifaddrs(interfaces);
  return found;
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
  constexpr std::array<std::string_view, 4> kProviders{kUdpm, kMpudpm, kTcpq, kMemq};
  return std::ranges::any_of(
      kProviders, [url](std::string_view provider) { return url.starts_with(provider); });
}

bool IsInMemory(std::string_view url) { return url.starts_with(kMemq); }

std::optional<MulticastAddress> ParseMulticastUrl(std::string_view url) {
  if (!url.starts_with(kUdpm)) return std::nullopt;
  MulticastAddress address = LcmsDefaults();
  if (!ReadMulticast(url, address).empty()) return std::nullopt;
  return address;
}

std::string UrlOnThisMachine(const MulticastAddress& address) {
  return fmt::format("udpm://{}:{}?ttl=0", address.group, address.port);
}

MulticastAddress MulticastAddressOf(std::string_view url) {
  MulticastAddress address = LcmsDefaults();
  ReadMulticast(url, address);
  return address;
}

std::string WhyWrongUrl(std::string_view url) {
  if (!IsLcmUrl(url)) return fmt::format("no LCM URL such as \"{}\"", kLcmDefaultUrl);
  if (const auto relay = ParseRelayUrl(url); relay && relay->port.value_or(0) == 0) {
    return NoPort(url.substr(url.find(':', kTcpq.size()) + 1));
  }
  if (!url.starts_with(kUdpm) && !url.starts_with(kMpudpm)) return "";
  MulticastAddress address = LcmsDefaults();
  return ReadMulticast(url, address);
}

void CheckUrl(std::string_view source, const std::string& url) {
  if (const std::string why = WhyWrongUrl(url); !why.empty()) {
    throw InputError(fmt::format("error: {} {}: {}", source, url, why));
  }
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
  if (!address || !IsMulticast(address->group)) return false;
  const int buffer = address->receive_buffer.value_or(kWideBuffer);
  return address->ttl <= 1 && buffer >= kLeastAnnouncedBuffer && buffer <= kWideBuffer;
}

}  // namespace fogline::runtime
