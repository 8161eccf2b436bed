// Lets the kernel drop LCM messages that nobody in this process has subscribed to.
//
// Every process of an LCM network is sent every message, and LCM's receiving thread wakes up for
// each, only to throw most of them away. With ten processes and nine messages a step, two thirds
// of all that a machine does for a step is waking threads for nothing. The kernel can look at the
// channel's name where the datagram arrives, and wake nobody (a socket filter, see socket(7)).
// Nothing else changes: what is subscribed arrives as before, in the same order.
//
// It also keeps from LCM's parser what no process of ours sends: fragments, whose bounds LCM does
// not check as it should (lcm-proj/lcm#628: a remote heap write), and whatever is no message at
// all.
#pragma once

#include <linux/filter.h>

#include <cstddef>
#include <string>
#include <vector>

namespace fogline {

/// What of a channel's data is wanted: that which has one of these texts at a place of its own.
struct Contents {
  std::size_t offset = 0;
  std::vector<std::string> texts;
};

/// A channel that is wanted; without texts all of it. Of a channel that is flooded only a share, in
/// [0, 1], drawn at random by the kernel.
struct Wanted {
  std::string channel;
  Contents contents{};
  double share = 1;
};

/// A filter program that takes LCM datagrams ("LC02": int32 sequence number, channel, 0, data) on
/// these channels, of up to kMaxMessageBytes of data and a signature, and nothing else. Fragments
/// of large messages ("LC03") are not taken.
/// @throws std::logic_error if more is wanted of a channel than the kernel can jump over
std::vector<sock_filter> ChannelFilter(std::vector<Wanted> wanted);

/// The same for all channels: whatever is a whole LCM message of that size, with a name that ends.
std::vector<sock_filter> AnyChannelFilter();

/// Filters what the socket receives from now on, instead of by an earlier filter.
/// @return false where the kernel will not: the socket goes on as before
/// @throws std::logic_error if the program is longer than the kernel takes any (BPF_MAXINSNS)
[[nodiscard]] bool AttachFilter(int socket, std::vector<sock_filter> program);

}  // namespace fogline
