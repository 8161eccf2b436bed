// Lets the kernel drop LCM messages that this process has not subscribed to.
//
// Every process of an LCM network receives every message. Without a filter, a process wakes up for
// each message, and drops most messages. With ten processes and nine messages a step, two thirds of
// a machine's work for a step is spent on waking threads that then have nothing to do.
// With a socket filter (socket(7)) the kernel reads the channel's name when a datagram arrives, and
// wakes no thread for an unwanted datagram. Nothing else changes: subscribed messages arrive in the
// same order.
//
// The filter also drops datagrams that no Fogline process sends, before they reach a parser.
// Such datagrams are fragments, and datagrams that are not LCM messages. LCM does not check the
// bounds of fragments properly (lcm-proj/lcm#628: a remote heap write).
#pragma once

#include <linux/filter.h>

#include <cstddef>
#include <string>
#include <vector>

namespace fogline::runtime {

/// Selects messages of a channel by their data: a wanted message has one of `texts` at `offset` (in
/// bytes).
struct Contents {
  std::size_t offset = 0;
  std::vector<std::string> texts;
};

/// A wanted channel. If `contents` has no texts, all messages of the channel are wanted. `share`,
/// in [0, 1], limits a flood: the kernel accepts this share of the messages, chosen at random.
struct Wanted {
  std::string channel;
  Contents contents{};
  double share = 1;
};

/// A filter program that accepts only LCM datagrams ("LC02": int32 sequence number, channel, 0,
/// data) on these channels. It drops fragments of large messages ("LC03"), and datagrams that are
/// longer than a message with the longest channel name, kMaxMessageBytes of data and a signature.
/// @throws std::logic_error if the contents of a channel need more instructions than a jump can
///     skip
std::vector<sock_filter> ChannelFilter(std::vector<Wanted> wanted);

/// A filter program that accepts the messages of all channels: every whole LCM message that is not
/// too large and whose channel name ends with a 0.
std::vector<sock_filter> AnyChannelFilter();

/// Attaches a filter to the socket, in place of an earlier filter.
/// @return false if the kernel refuses; the socket then works as before
/// @throws std::logic_error if the program is longer than the kernel allows (BPF_MAXINSNS)
[[nodiscard]] bool AttachFilter(int socket, std::vector<sock_filter> program);

}  // namespace fogline::runtime
