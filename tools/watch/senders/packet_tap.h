// Listens to the packets of a udpm:// network beside LCM. LCM's library throws the numbers of
// messages away, so a second socket in the same multicast group reads them.
#pragma once

#include <memory>
#include <string>

#include "common/clock.h"
#include "services/runtime/transport/udpm/lcm_packet.h"
#include "tools/watch/senders/packet_socket.h"
#include "tools/watch/senders/senders.h"

namespace fogline::watch {

/// For one thread. It sends nothing, and reads only the heads of packets. It also says how many
/// packets the kernel dropped because this process did not read them in time (SO_RXQ_OVFL): their
/// messages may have reached all other processes.
class PacketTap {
 public:
  /// Begins to listen. @param senders gets the packets, and must outlive the tap
  /// @return nullptr if the URL is of another transport, whose packets have no numbers
  /// @throws std::runtime_error if the network cannot be heard
  static std::unique_ptr<PacketTap> Open(const std::string& url, Senders& senders);

  /// Takes the packets that are there, but at most kDrained, so that a flood does not keep the
  /// caller from other work.
  void Drain(TimePoint now);
  static constexpr int kDrained = 4096;

  /// This descriptor is readable when packets are there.
  int fd() const { return socket_.fd(); }

 private:
  PacketTap(const std::string& url, Senders& senders)
      : socket_(url, {.packet_bytes = runtime::kPacketHead}), senders_(senders) {}

  PacketSocket socket_;
  Senders& senders_;
};

}  // namespace fogline::watch
