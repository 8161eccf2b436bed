// Receives the packets of a udpm:// network in addition to LCM. LCM's library does not pass on the
// numbers of messages, so a second socket in the same multicast group reads them.
#pragma once

#include <memory>
#include <string>

#include "common/clock.h"
#include "services/runtime/transport/udpm/lcm_packet.h"
#include "tools/watch/senders/packet_socket.h"
#include "tools/watch/senders/senders.h"

namespace fogline::watch {

/// Reads only the heads of packets, and sends nothing. For use in one thread. It also counts the
/// packets that the kernel dropped because this process did not read them in time (SO_RXQ_OVFL).
/// The messages in these packets may have reached all other processes.
class PacketTap {
 public:
  /// Begins to listen. @param senders gets the packets, and must outlive the tap
  /// @return nullptr if the URL is of another transport, whose packets have no numbers
  /// @throws std::runtime_error if the socket cannot be opened
  static std::unique_ptr<PacketTap> Open(const std::string& url, Senders& senders);

  /// Takes the packets that have come, but at most kDrained, so that many packets do not keep the
  /// caller from other work.
  void Drain(TimePoint now);
  static constexpr int kDrained = 4096;

  /// A descriptor that is readable when packets have come.
  int fd() const { return socket_.fd(); }

 private:
  PacketTap(const std::string& url, Senders& senders)
      : socket_(url, {.packet_bytes = runtime::kPacketHead}), senders_(senders) {}

  PacketSocket socket_;
  Senders& senders_;
};

}  // namespace fogline::watch
