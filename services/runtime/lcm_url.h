// Which LCM network a program uses: one rule for every program. And what the URL of a network says.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fogline {

/// LCM's own default address, for traffic that stays on this machine.
inline constexpr std::string_view kLcmDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";

/// $LCM_DEFAULT_URL, which LCM's own programs read too; nothing if it is unset or empty.
std::optional<std::string> UrlOfEnvironment();

/// The network of a program: the URL that its command line gives, if it is not empty; else
/// $LCM_DEFAULT_URL; else LCM's default address.
std::string NetworkUrl(const std::string& given);

/// Where a program listens that was given no URL, and where a run announces itself (beacon.h).
inline std::string MeetingUrl() { return NetworkUrl(""); }

/// Whether the text begins as the URL of an LCM network does, memq included.
bool IsLcmUrl(std::string_view url);

/// What a udpm:// URL says, with LCM's defaults where it says nothing.
struct MulticastAddress {
  std::string group;
  std::uint16_t port = 0;
  int ttl = 0;

  bool operator==(const MulticastAddress&) const = default;
};

/// Nothing if it is no udpm:// URL, names a host by anything but an IPv4 address in numbers, or has
/// an option that LCM does not know.
std::optional<MulticastAddress> ParseMulticastUrl(std::string_view url);

/// Whether two URLs name one network: group and port of udpm, host and port of tcpq, else the URL
/// without its options.
bool SameNetwork(std::string_view a, std::string_view b);

/// Whether a program may go to this network because a message says so: a multicast group whose
/// traffic gets no further than the next router (ttl 0 or 1), or a relay of this machine by its
/// address in numbers. Not mpudpm, where nothing filters what reaches LCM's parser.
bool MayBeAnnounced(std::string_view url);

}  // namespace fogline
