#include "services/runtime/lcm_url.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>

#include "services/runtime/multicast_route.h"
#include "services/runtime/tcpq_url.h"

namespace fogline {
namespace {

constexpr std::string_view kUdpm = "udpm://";
constexpr std::string_view kTcpq = "tcpq://";
constexpr std::uint16_t kLcmPort = 7667;
// A URL of LCM's with all its options takes 60 characters.
constexpr std::size_t kMaxAnnounced = 200;

template <class Integer>
std::optional<Integer> ParseNumber(std::string_view text) {
  Integer value{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || rest != end) return std::nullopt;
  return value;
}

std::optional<in_addr> ParseAddress(std::string_view text) {
  in_addr address{};
  if (inet_pton(AF_INET, std::string(text).c_str(), &address) != 1) return std::nullopt;
  return address;
}

/// Takes what stands before `separator`, and the separator, off the front of `text`.
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
    if (name == "ttl") {
      address.ttl = *number;
    } else if (name != "recv_buf_size") {
      return false;
    }
  }
  return true;
}

/// An address is of this machine if a socket can be bound to it.
bool IsOfThisMachine(in_addr numeric) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr = numeric;
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool bound = bind(probe, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  close(probe);
  return bound;
}

bool IsRelayOfThisMachine(std::string_view place) {
  const std::string_view host = TakeUntil(':', place);
  const auto address = ParseAddress(host);
  const auto port = place.empty() ? tcpq::kDefaultPort : ParseNumber<std::uint16_t>(place);
  return address && address->s_addr != htonl(INADDR_ANY) && port && *port != 0 &&
         IsOfThisMachine(*address);
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
  // LCM's own ttl is 0, as is ours (bus.h).
  MulticastAddress address{.group = *GroupOf(url), .port = kLcmPort, .ttl = 0};
  TakeUntil(':', place);
  if (!place.empty()) {
    const auto port = ParseNumber<std::uint16_t>(place);
    if (!port) return std::nullopt;
    address.port = *port;
  }
  if (!ParseAddress(address.group) || !ReadOptions(options, address)) return std::nullopt;
  return address;
}

bool SameNetwork(std::string_view a, std::string_view b) {
  const auto one = ParseMulticastUrl(a);
  const auto other = ParseMulticastUrl(b);
  if (one && other) return one->group == other->group && one->port == other->port;
  return TakeUntil('?', a) == TakeUntil('?', b);
}

bool MayBeAnnounced(std::string_view url) {
  if (url.size() > kMaxAnnounced) return false;
  if (url.starts_with(kTcpq)) return IsRelayOfThisMachine(url.substr(kTcpq.size()));
  const auto address = ParseMulticastUrl(url);
  return address && IsMulticast(address->group) && address->port != 0 && address->ttl <= 1;
}

}  // namespace fogline
