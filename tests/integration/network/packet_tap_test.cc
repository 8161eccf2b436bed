// The tap on a multicast group (watch::PacketTap). The senders are real LCM instances.
#include "tools/watch/senders/packet_tap.h"

#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <poll.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <sstream>

#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/support/command.h"
#include "tests/support/numbered_sender.h"

namespace fogline::test {
namespace {

using watch::SenderView;

/// The view of the sender on this channel; an empty view if no sender uses the channel.
SenderView SenderOn(const watch::Senders& senders, const std::string& channel) {
  for (const SenderView& sender : senders.View(Clock::now()).senders) {
    if (std::ranges::find(sender.channels, channel) != sender.channels.end()) return sender;
  }
  return {};
}

/// Number of packets that the kernel has dropped before they reached a socket. The kernel drops
/// packets if a processor is too busy (netdev_max_backlog). The tap counts such packets as lost on
/// the network.
std::int64_t DroppedByKernel() {
  std::ifstream table("/proc/net/softnet_stat");  // a line for each processor
  std::int64_t sum = 0;
  for (std::string line; std::getline(table, line);) {
    std::istringstream columns(line);
    std::int64_t dropped = 0;
    std::string handled;
    columns >> handled >> std::hex >> dropped;
    sum += dropped;
  }
  return sum;
}

/// Takes packets until the condition holds. @return false after the time limit
bool DrainUntil(watch::PacketTap& tap, const std::function<bool()>& condition) {
  const TimePoint end = Clock::now() + kPatience;
  while (tap.Drain(Clock::now()), !condition()) {
    if (Clock::now() > end) return false;
    pollfd packets{.fd = tap.fd(), .events = POLLIN, .revents = 0};
    poll(&packets, 1, 10);
  }
  return true;
}

class PacketTapTest : public testing::Test {
 protected:
  std::int64_t Received(const std::string& channel) const {
    return SenderOn(senders_, channel).counts.received;
  }

  std::string url_ = runtime::FreshMulticastUrl();
  watch::Senders senders_;
  std::unique_ptr<watch::PacketTap> tap_ = watch::PacketTap::Open(url_, senders_);
};

TEST_F(PacketTapTest, HearsEveryMessageOfALcmInstanceEvenTheLongOnes) {
  constexpr int kShort = 200;
  constexpr std::size_t kLongBytes = 300'000;  // LCM sends it in fragments
  const std::unique_ptr<lcm_t, void (*)(lcm_t*)> lcm(lcm_create(url_.c_str()), lcm_destroy);
  ASSERT_TRUE(lcm);
  const std::vector<std::uint8_t> data(kLongBytes, 1);
  for (int i = 0; i < kShort; ++i) {
    ASSERT_EQ(lcm_publish(lcm.get(), "POSE", data.data(), 10), 0);
  }
  ASSERT_EQ(lcm_publish(lcm.get(), "IMAGE", data.data(), kLongBytes), 0);
  ASSERT_EQ(lcm_publish(lcm.get(), "END", data.data(), 1), 0);
  // The test has sent kShort + 2 messages. The LCM instance also sends messages of its self-test.
  ASSERT_TRUE(DrainUntil(*tap_, [&] { return Received("END") >= kShort + 2; }));
  const SenderView sender = SenderOn(senders_, "END");
  EXPECT_EQ(sender.channels, (std::vector<std::string>{"POSE", "IMAGE", "END"}));
  EXPECT_EQ(sender.counts, (watch::SenderSequence::Counts{.received = sender.counts.received}));
}

TEST_F(PacketTapTest, HearsSeveralSendersAndTellsThemApart) {
  runtime::Bus first(url_);
  runtime::Bus second(url_);
  const NumberedSender skipping(url_);
  for (std::uint32_t number = 0; number < 60; ++number) {
    first.Publish("FIRST", std::vector<std::uint8_t>{1});
    second.Publish("SECOND", std::vector<std::uint8_t>{1});
    if (number % 3 != 1) skipping.Send(number, "SKIPPING");
  }
  ASSERT_TRUE(DrainUntil(*tap_, [&] {
    return Received("FIRST") >= 60 && Received("SECOND") >= 60 && Received("SKIPPING") >= 40;
  }));
  EXPECT_EQ(SenderOn(senders_, "FIRST").counts.lost, 0);
  EXPECT_EQ(SenderOn(senders_, "SECOND").counts.lost, 0);
  EXPECT_EQ(SenderOn(senders_, "SKIPPING").counts.lost, 20);
  EXPECT_EQ(SenderOn(senders_, "SKIPPING").address, skipping.Address());
  EXPECT_EQ(senders_.View(Clock::now()).own_overflow, 0);
}

TEST_F(PacketTapTest, TellsItsOwnOverflowFromLossOnTheNetwork) {
  // GIVEN more packets than the tap's buffer holds, while no process reads them
  constexpr std::uint32_t kFlood = 60'000;
  const std::int64_t dropped_before = DroppedByKernel();
  const NumberedSender sender(url_);
  for (std::uint32_t number = 0; number < kFlood; ++number) sender.Send(number, "FLOOD");
  // WHEN the tap reads again, and the sender continues
  std::uint32_t number = kFlood;
  ASSERT_TRUE(DrainUntil(*tap_, [&] {
    sender.Send(number++, "FLOOD");
    return senders_.View(Clock::now()).own_overflow > 0;
  }));
  ASSERT_TRUE(DrainUntil(*tap_, [&] {
    const auto counts = SenderOn(senders_, "FLOOD").counts;
    return counts.received + counts.lost + counts.missed_here == number;
  }));
  // THEN the messages for which the tap's buffer had no room count as missed by the tap. Only
  // messages that the kernel dropped before they reached a socket count as lost
  const auto counts = SenderOn(senders_, "FLOOD").counts;
  EXPECT_EQ(counts.missed_here, senders_.View(Clock::now()).own_overflow);
  EXPECT_LE(counts.lost, DroppedByKernel() - dropped_before);
  // AND a message that the sender leaves out after the overflow counts as lost
  ++number;
  sender.Send(number, "FLOOD");
  ASSERT_TRUE(DrainUntil(
      *tap_, [&] { return SenderOn(senders_, "FLOOD").counts.lost == counts.lost + 1; }));
}

TEST_F(PacketTapTest, HearsNoOtherGroupOnItsPort) {
  std::string other = url_;
  other.replace(other.find("239.255.76.67"), std::string("239.255.76.67").size(), "239.255.76.68");
  watch::Senders others;
  const auto other_tap = watch::PacketTap::Open(other, others);
  const NumberedSender mine(url_);
  const NumberedSender foreign(other);
  foreign.Send(0, "FOREIGN");
  mine.Send(0, "MINE");
  ASSERT_TRUE(DrainUntil(*tap_, [&] { return Received("MINE") == 1; }));
  EXPECT_EQ(Received("FOREIGN"), 0);
  ASSERT_TRUE(
      DrainUntil(*other_tap, [&] { return SenderOn(others, "FOREIGN").counts.received == 1; }));
}

TEST(PacketTapUrlTest, ListensToNothingButUdpMulticast) {
  watch::Senders senders;
  EXPECT_EQ(watch::PacketTap::Open("memq://", senders), nullptr);
  EXPECT_EQ(watch::PacketTap::Open("tcpq://127.0.0.1:7700", senders), nullptr);
}

}  // namespace
}  // namespace fogline::test
