// The packets of an LCM network, in `fogline top`. Input: for each packet two bytes and a datagram.
// The first byte is the port of the sender. The second byte is the time since the previous packet,
// in units of 10 ms. The highest bit of the second byte tells whether this process dropped a packet
// before this one.
#include <nlohmann/json.hpp>

#include "tests/fuzz/samples.h"
#include "tools/watch/senders/senders_report.h"

namespace fogline::fuzz {
namespace {

constexpr std::size_t kMaxPackets = 512;
constexpr Duration kTick = milliseconds(10);
constexpr std::uint8_t kDroppedBit = 0x80;

void DemandPossible(const watch::SendersView& view, std::int64_t packets, std::int64_t dropped) {
  Demand(view.senders.size() <= watch::Senders::kMaxSenders, "senders fill no memory");
  Demand(view.own_overflow == dropped, "own drops are counted");
  std::int64_t taken = view.not_lcm;
  for (const watch::SenderView& sender : view.senders) {
    const watch::SenderSequence::Counts& counts = sender.counts;
    Demand(sender.channels.size() <= watch::Senders::kMaxChannels, "channels fill no memory");
    Demand(counts.lost >= 0 && counts.missed_here >= 0, "less than none is not lost");
    Demand(counts.missed_here <= dropped, "no more is missed here than was dropped here");
    Demand(counts.late <= counts.received, "what is late has arrived");
    taken += counts.received + counts.duplicates;
  }
  Demand(taken <= packets, "each packet counts once");
}

void DemandShowable(const watch::SendersView& view) {
  for (const watch::Line& line : watch::SenderLines(view)) {
    Demand(Printable(line.text) && line.text.find('\n') == std::string::npos,
           "a line can be written to a terminal");
  }
  const std::string text = watch::SendersJson(view).dump(
      -1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  Demand(nlohmann::json::accept(text), "the JSON text is valid JSON");
}

void DemandSoundCounts(runtime::Bytes input) {
  watch::Senders senders;
  TimePoint now{};
  Cutter cutter(input);
  std::int64_t packets = 0;
  std::int64_t dropped = 0;
  while (packets < static_cast<std::int64_t>(kMaxPackets) && !cutter.empty()) {
    const std::uint16_t port = cutter.Byte();
    const std::uint8_t time = cutter.Byte();
    now += kTick * (time & ~kDroppedBit);
    if ((time & kDroppedBit) != 0) {
      senders.AddDropped(1);
      ++dropped;
    }
    senders.Add({.host = 0x7f000001, .port = port}, cutter.Datagram(), now);
    ++packets;
  }
  const watch::SendersView view = senders.View(now);
  DemandPossible(view, packets, dropped);
  DemandShowable(view);
  if (!view.senders.empty()) Took();
}

void Append(std::uint64_t number, std::size_t size, Input& bytes) {
  for (std::size_t i = size; i > 0; --i) {
    bytes.push_back(static_cast<std::uint8_t>(number >> (8 * (i - 1))));
  }
}

void AddPacket(const Input& packet, std::uint8_t time, Input& input) {
  input.insert(input.end(), {1, time});
  AddDatagram(packet, input);
}

Input Short(std::uint32_t number) {
  Input packet{'L', 'C', '0', '2'};
  Append(number, 4, packet);
  packet.insert(packet.end(), {'E', 'G', 'O', 0, 1});
  return packet;
}

Input Fragment(std::uint32_t number, std::uint32_t fragment, std::uint32_t fragments) {
  Input packet{'L', 'C', '0', '3'};
  Append(number, 4, packet);
  Append(100, 4, packet);
  Append(50 * fragment, 4, packet);
  Append(fragment, 2, packet);
  Append(fragments, 2, packet);
  if (fragment == 0) packet.insert(packet.end(), {'B', 'I', 'G', 0});
  packet.push_back(1);
  return packet;
}

}  // namespace

std::vector<Input> Seeds() {
  Input lossy;
  for (const std::uint32_t number : {0U, 1U, 4U, 2U, 4U, 5U}) AddPacket(Short(number), 1, lossy);
  Input restarted;
  for (const std::uint32_t number : {70000U, 70001U, 0U, 1U, 2U, 5000U, 5001U}) {
    AddPacket(Short(number), 1, restarted);
  }
  Input silent;
  for (const std::uint32_t number : {0U, 1U, 2U}) AddPacket(Short(number), 1, silent);
  for (const std::uint32_t number : {0U, 1U}) AddPacket(Short(number), 0x7f, silent);
  Input dropping;
  for (const std::uint32_t number : {0xfffffffeU, 1U, 2U}) {
    AddPacket(Short(number), kDroppedBit, dropping);
  }
  Input fragments;
  AddPacket(Short(6), 1, fragments);
  for (const std::uint32_t fragment : {0U, 1U, 2U})
    AddPacket(Fragment(7, fragment, 3), 1, fragments);
  for (const std::uint32_t fragment : {0U, 2U}) AddPacket(Fragment(8, fragment, 3), 1, fragments);
  AddPacket(Short(9), 1, fragments);
  AddPacket(Fragment(8, 1, 3), 1, fragments);
  return {lossy, restarted, silent, dropping, fragments};
}

}  // namespace fogline::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fogline::fuzz::DemandSoundCounts({data, size});
  return 0;
}
