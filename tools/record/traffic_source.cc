#include "tools/record/traffic_source.h"

#include <chrono>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/transport/multicast_route.h"
#include "tools/watch/senders/packet_socket.h"

namespace fogline::record {
namespace {

// Number of packets after which Drain() returns, so that the caller can do its other work.
constexpr int kDrained = 4096;

/// The messages of udpm (LCM's UDP multicast), assembled from packets. The numbers in the packets
/// show how many messages the log lacks.
class MulticastSource final : public TrafficSource {
 public:
  MulticastSource(const std::string& url, int buffer_bytes, watch::Senders& senders)
      : socket_(url, {.packet_bytes = MessageAssembler::kMostPacket, .buffer_bytes = buffer_bytes}),
        senders_(senders) {}

  void Drain(TimePoint now, const Use& use) override {
    int taken = 0;
    while (taken < kDrained) {
      const int count = socket_.Receive([&](const watch::Packet& packet) {
        senders_.AddDropped(packet.dropped);
        senders_.Add(packet.from, packet.bytes, now);
        if (const auto message = assembler_.Add(packet)) use(*message);
      });
      taken += count;
      if (count < static_cast<int>(watch::PacketSocket::kBatch)) break;
    }
    socket_.Attend(taken > 0, now);
  }
  std::string TakeNews() override { return ""; }

  int fd() const override { return socket_.fd(); }
  int buffer_bytes() const override { return socket_.buffer_bytes(); }
  bool is_numbered() const override { return true; }
  std::int64_t given_up() const override { return assembler_.given_up(); }

 private:
  watch::PacketSocket socket_;
  watch::Senders& senders_;
  MessageAssembler assembler_;
};

/// The messages of other networks, such as tcpq, received by a bus. They have no numbers, so lost
/// messages cannot be counted.
class BusSource final : public TrafficSource {
 public:
  explicit BusSource(const std::string& url) : bus_(url) {
    bus_.SubscribeAll([this](std::string_view channel, runtime::Bytes data) {
      const auto time = std::chrono::system_clock::now().time_since_epoch();
      (*use_)({.channel = channel,
               .unix_us = duration_cast<std::chrono::microseconds>(time).count(),
               .data = data});
    });
  }

  void Drain(TimePoint /*now*/, const Use& use) override {
    use_ = &use;
    bus_.Drain();
  }
  std::string TakeNews() override {
    const std::string why = bus_.WhyCutOff();
    const bool is_cut_off = !why.empty();
    if (std::exchange(is_cut_off_, is_cut_off) == is_cut_off) return "";
    if (!is_cut_off) return fmt::format("records {} again", bus_.url());
    return fmt::format("warning: {}; until it is reached again, nothing of it is recorded", why);
  }

  int fd() const override { return bus_.fd(); }
  int buffer_bytes() const override { return 0; }
  bool is_numbered() const override { return false; }
  std::int64_t given_up() const override { return 0; }

 private:
  runtime::Bus bus_;
  const Use* use_ = nullptr;
  bool is_cut_off_ = false;
};

}  // namespace

std::unique_ptr<TrafficSource> TrafficSource::Open(const std::string& url, int buffer_bytes,
                                                   watch::Senders& senders) {
  if (runtime::ParseMulticastUrl(url)) {
    if (const std::string why = runtime::WhyNoMulticast(url); !why.empty()) {
      throw InputError("error: " + why);
    }
    return std::make_unique<MulticastSource>(url, buffer_bytes, senders);
  }
  return std::make_unique<BusSource>(url);
}

}  // namespace fogline::record
