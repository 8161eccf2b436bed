// Lets the kernel drop LCM messages that nobody in this process has subscribed to.
//
// Every process of an LCM network is sent every message, and LCM's receiving thread wakes up for
// each, only to throw most of them away. With ten processes and nine messages a step, two thirds
// of all that a machine does for a step is waking threads for nothing. The kernel can look at the
// channel's name where the datagram arrives, and wake nobody (a socket filter, see socket(7)).
// Nothing else changes: what is subscribed arrives as before, in the same order.
#pragma once

#include <linux/filter.h>

#include <string>
#include <vector>

namespace fogline {

/// UDP sockets (IPv4) of this process.
std::vector<int> UdpSockets();

/// A filter program that takes LCM datagrams ("LC02": int32 sequence number, channel, 0, data) on
/// these channels, and everything that is none, such as fragments of large messages ("LC03"), of
/// which only the first says its channel.
std::vector<sock_filter> ChannelFilter(std::vector<std::string> channels);

/// Filters what the socket receives from now on, instead of by an earlier filter. Where the kernel
/// will not, the socket goes on receiving everything.
void AttachFilter(int socket, std::vector<sock_filter> program);

/// Lets the socket receive everything again.
void DetachFilter(int socket);

}  // namespace fogline
