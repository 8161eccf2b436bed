// A UDP socket that receives the packets of a udpm:// network in addition to the socket of the bus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/clock.h"
#include "services/runtime/transport/kernel_limits.h"
#include "services/runtime/transport/lcm_sockets.h"
#include "services/runtime/transport/udpm/group_socket.h"
#include "services/runtime/wire/wire.h"
#include "tools/watch/senders/senders.h"

namespace fogline::watch {

/// A packet as the kernel has received it.
struct Packet {
  SenderAddress from;
  runtime::Bytes bytes;  // valid during the call
  // Number of packets that the kernel dropped between the previous packet and this packet, because
  // the socket's buffer was full (SO_RXQ_OVFL).
  std::uint32_t dropped = 0;
  std::int64_t unix_us = 0;  // time of arrival, in us since 1970
};

/// Receives packets, and sends nothing. For use in one thread.
class PacketSocket {
 public:
  struct Options {
    std::size_t packet_bytes;  // each packet is cut off after this many bytes
    // Size of the receive buffer; without CAP_NET_ADMIN at most net.core.rmem_max.
    int buffer_bytes = runtime::kWideBuffer;
  };

  /// @pre the URL is a udpm:// URL (runtime::ParseMulticastUrl)
  /// @throws std::runtime_error if the socket cannot be opened
  PacketSocket(const std::string& url, const Options& options);
  ~PacketSocket();
  PacketSocket(const PacketSocket&) = delete;
  PacketSocket& operator=(const PacketSocket&) = delete;

  /// Calls `use` for the packets that have come, at most kBatch. @return the number of packets
  int Receive(const std::function<void(const Packet&)>& use);
  static constexpr std::size_t kBatch = 64;

  /// If no packet has come for a second, renews the membership of the multicast group, as a bus
  /// does. Without membership_ there is nothing to renew.
  /// @param heard whether packets have come at `now`
  void Attend(bool heard, TimePoint now);

  int fd() const { return socket_->fd(); }
  /// The size of the buffer that the kernel grants.
  int buffer_bytes() const { return runtime::ReceiveBuffer(socket_->fd()); }

 private:
  struct Batch;

  std::unique_ptr<runtime::GroupSocket> socket_;
  std::unique_ptr<Batch> batch_;  // buffers for one system call
  std::uint32_t dropped_ = 0;  // the kernel's count of packets that found no room; it wraps around
  // Set if the packets come over a route of this machine. Such a route may change.
  std::optional<runtime::GroupMembership> membership_;
  TimePoint heard_{};  // time of the last packet, or of the last renewal
};

}  // namespace fogline::watch
