// Decides which LCM network a program uses, by one rule for every program. Also reads the URLs of
// networks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fogline::runtime {

/// LCM's own default address, for traffic that stays on this machine.
inline constexpr std::string_view kLcmDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";

/// $LCM_DEFAULT_URL, which LCM's own programs read, too; nullopt if it is unset or empty.
std::optional<std::string> UrlOfEnvironment();

/// The network of a program: the URL from the command line (`given`); if this is empty,
/// $LCM_DEFAULT_URL; if this is unset or empty, LCM's default address.
std::string NetworkUrl(const std::string& given);

/// The network on which programs without a URL listen, and on which runs announce themselves
/// (beacon.h).
inline std::string MeetingUrl() { return NetworkUrl(""); }

/// Whether the text begins like the URL of an LCM network, including memq.
bool IsLcmUrl(std::string_view url);

/// Whether the messages of a network stay in the memory of one process (memq).
bool IsInMemory(std::string_view url);

/// The contents of a udpm:// or mpudpm:// URL, with LCM's defaults for missing parts.
struct MulticastAddress {
  std::string group;
  std::uint16_t port = 0;
  int ports = 1;  // nports of mpudpm: the number of ports, from `port` on
  int ttl = 0;
  std::optional<int> receive_buffer;  // recv_buf_size, in bytes

  bool operator==(const MulticastAddress&) const = default;
};

/// The contents of a udpm:// URL; nullopt if the text is not a udpm:// URL, or if it is
/// wrong (WhyWrongUrl()).
std::optional<MulticastAddress> ParseMulticastUrl(std::string_view url);

/// The URL of the same group and port, for messages that do not leave this machine.
std::string UrlOnThisMachine(const MulticastAddress& address);

/// The contents of a udpm:// or mpudpm:// URL. @pre nothing is wrong in the URL (WhyWrongUrl())
MulticastAddress MulticastAddressOf(std::string_view url);

/// Says what is wrong in a URL of an LCM network; "" if nothing is wrong. An error can be in the
/// beginning of the text, in the address of udpm or mpudpm, in the port, or in an option. The host
/// of a relay (tcpq) is not checked here (tcpq_url.h). Fogline accepts fewer URLs than LCM does.
/// LCM ignores unknown options, also a mistyped ttl, and it reads 010 as 8.
std::string WhyWrongUrl(std::string_view url);

/// @param source the source of the URL, such as "--lcm-url"
/// @throws InputError that names the source, if WhyWrongUrl() finds an error
void CheckUrl(std::string_view source, const std::string& url);

/// Whether two URLs name one network. Compares group and port of udpm URLs, host and port of tcpq
/// URLs, and the text before the options of other URLs.
bool SameNetwork(std::string_view a, std::string_view b);

/// Whether a program may join this network if the program knows the URL only from a message. The
/// URL may name a relay of this machine, with its address in numbers. The URL may also name a
/// multicast group whose traffic ends at the next router or before (ttl 0 or 1). If such a URL
/// gives the size of the receive buffer, the size must be between 100 kB and kWideBuffer. mpudpm is
/// refused: it has no filter, so every packet would reach LCM's parser.
bool MayBeAnnounced(std::string_view url);

}  // namespace fogline::runtime
