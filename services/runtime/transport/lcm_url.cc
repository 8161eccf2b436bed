#include "services/runtime/transport/lcm_url.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

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
constexpr int kMostTtl = 255;  // the field has 8 bits (RFC 791, section 3.1)
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

/// The value of an option as LCM reads it: decimal, octal or hexadecimal.
std::optional<long> ReadLikeLcm(std::string_view value) {
  const std::string text(value);
  char* end = nullptr;
  const long number = std::strtol(text.c_str(), &end, 0);
  if (text.empty() || *end != '\0') return std::nullopt;
  return number;
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
  return address && address->s_addr != htonl(INADDR_ANY) && tcpq::IsOfThisMachine(*address);
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

std::string WhyWrongUdpm(std::string_view url) {
  if (!url.starts_with(kUdpm)) return "";
  std::string_view options = url.substr(kUdpm.size());
  const std::string_view place = TakeUntil('?', options);
  const std::size_t colon = place.find(':');
  const std::string_view address = place.substr(0, colon);
  if (!place.empty() && !ParseAddress(address)) {
    return fmt::format("{} is no IPv4 address in numbers", QuoteShort(address));
  }
  if (colon != std::string_view::npos && !ParseNumber<std::uint16_t>(place.substr(colon + 1))) {
    return fmt::format("{} is no port (0 to 65535)", QuoteShort(place.substr(colon + 1)));
  }
  while (!options.empty()) {
    std::string_view value = TakeUntil('&', options);
    const std::string_view name = TakeUntil('=', value);
    if (name != kTtl && name != kReceiveBuffer) {
      return fmt::format("udpm has no option {}; its options are {} and {}", QuoteShort(name), kTtl,
                         kReceiveBuffer);
    }
    const int most = name == kTtl ? kMostTtl : std::numeric_limits<int>::max();
    const auto number = ReadLikeLcm(value);
    if (!number || *number < 0 || *number > most) {
      return fmt::format("{} is {}, which is no number from 0 to {}", name, QuoteShort(value),
                         most);
    }
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
