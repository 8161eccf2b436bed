// The buffers and descriptors that the kernel grants to a process on a network.
#pragma once

namespace fogline::runtime {

/// The receive buffer that a process asks for, in bytes.
inline constexpr int kWideBuffer = 8 * 1024 * 1024;
/// Size in bytes of a receive buffer that has room for a burst of 5,000 messages of a run. With the
/// kernel's default size, 88 % of this burst is lost. `fogline doctor` warns of a smaller buffer.
inline constexpr int kEnoughBuffer = 2 * 1024 * 1024;

/// Gives a socket a receive buffer. With the kernel's default limit, the buffer holds a hundred
/// datagrams. A flood of 20,000 datagrams a second fills such a buffer in 5 ms. A larger buffer has
/// room for the messages that come while a busy machine runs other processes.
/// @param bytes the size; without CAP_NET_ADMIN, the kernel limits it to net.core.rmem_max
void SetReceiveBuffer(int socket, int bytes);

/// The size of a socket's receive buffer, in bytes.
int ReceiveBuffer(int socket);

/// errno if this process cannot open the descriptors that LCM needs for a network, otherwise 0.
int LackOfDescriptors();

}  // namespace fogline::runtime
