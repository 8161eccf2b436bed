#include "tools/watch/senders/packet_tap.h"

#include "services/runtime/transport/lcm_url.h"

namespace fogline::watch {

std::unique_ptr<PacketTap> PacketTap::Open(const std::string& url, Senders& senders) {
  if (!runtime::ParseMulticastUrl(url)) return nullptr;
  return std::unique_ptr<PacketTap>(new PacketTap(url, senders));
}

void PacketTap::Drain(TimePoint now) {
  int taken = 0;
  while (taken < kDrained) {
    const int count = socket_.Receive([&](const Packet& packet) {
      senders_.AddDropped(packet.dropped);
      senders_.Add(packet.from, packet.bytes, now);
    });
    taken += count;
    if (count < static_cast<int>(PacketSocket::kBatch)) break;
  }
  socket_.Attend(taken > 0, now);
}

}  // namespace fogline::watch
