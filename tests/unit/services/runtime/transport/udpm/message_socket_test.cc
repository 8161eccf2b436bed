#include "services/runtime/transport/udpm/message_socket.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/lcm_url.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "services/runtime/wire/channel_filter.h"
#include "tests/unit/services/runtime/transport/raw_datagram.h"

namespace fogline::test {
namespace {

using namespace std::string_literals;

constexpr Duration kLong = std::chrono::seconds(5);

std::string ChannelOf(runtime::MessageSocket& socket) {
  const auto message = socket.Take();
  return message ? std::string(message->channel) : "";
}

TEST(MessageSocketTest, ReceivesWhatLcmSends) {
  const std::string url = runtime::FreshMulticastUrl();
  runtime::MessageSocket socket(url, runtime::ChannelFilter({{"RADAR"}}));
  ASSERT_TRUE(socket.filtered());
  EXPECT_FALSE(socket.Wait(Duration::zero()));
  runtime::Bus sender(url);
  sender.Publish("LIDAR", std::vector<std::uint8_t>{1});
  sender.Publish("RADAR", std::vector<std::uint8_t>{2, 3});
  ASSERT_TRUE(socket.Wait(kLong));
  EXPECT_TRUE(socket.Wait(Duration::zero()));  // the message is still there
  const auto message = socket.Take();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, "RADAR");
  EXPECT_EQ(std::vector<std::uint8_t>(message->data.begin(), message->data.end()),
            (std::vector<std::uint8_t>{2, 3}));
  EXPECT_FALSE(socket.Take());
  EXPECT_FALSE(socket.Wait(Duration::zero()));
}

TEST(MessageSocketTest, TakesOnlyWholeMessagesOfFoglinesSize) {
  const std::string url = runtime::FreshMulticastUrl();
  runtime::MessageSocket socket(url, {});  // without channels, so the kernel drops nothing
  constexpr std::size_t kMost = runtime::kMaxMessageBytes + runtime::kSignatureBytes;
  for (const std::string& packet :
       {""s, "LC02"s, "LC01\0\0\0\1A\0data"s, "LC02\0\0\0\1no end"s,
        "LC03\0\0\0\1\0\0\0\4\0\0\0\0\0\0\0\1WHOLE\0abcd"s,
        "LC03\0\0\0\1\0\0\0\0\0\0\0\0\0\0\0\1NOTHING\0"s,
        "LC03\0\0\0\1\0\0\0\x8\0\0\0\0\0\0\0\2FIRST\0abcd"s,
        "LC02\0\0\0\1LARGE\0"s + std::string(kMost + 1, 'x'), std::string(9000, 'x')}) {
    SendDatagram(url, packet);
  }
  SendDatagram(url, "LC02\0\0\0\1LARGEST\0"s + std::string(kMost, 'x'));
  SendDatagram(url, "LC02\0\0\0\2EMPTY\0"s);
  ASSERT_TRUE(socket.Wait(kLong));
  EXPECT_EQ(ChannelOf(socket), "LARGEST");
  ASSERT_TRUE(socket.Wait(kLong));
  EXPECT_EQ(ChannelOf(socket), "EMPTY");
  EXPECT_FALSE(socket.Wait(Duration::zero()));
}

TEST(MessageSocketTest, IsNotHeldUpByPacketsThatAreNoMessages) {
  const std::string url = runtime::FreshMulticastUrl();
  runtime::MessageSocket socket(url, {});
  for (int i = 0; i < 150; ++i) SendDatagram(url, "noise");
  SendDatagram(url, "LC02\0\0\0\1LAST\0"s);
  EXPECT_FALSE(socket.Wait(Duration::zero()));  // Wait() returns before the last packet
  ASSERT_TRUE(socket.Wait(kLong));
  EXPECT_EQ(ChannelOf(socket), "LAST");
}

TEST(MessageSocketTest, WaitsOnAfterPacketsThatAreNoMessages) {
  const std::string url = runtime::FreshMulticastUrl();
  runtime::MessageSocket socket(url, {});
  const std::jthread other([&url] {
    for (int i = 0; i < 5; ++i) {
      std::this_thread::sleep_for(milliseconds(20));  // the socket waits meanwhile
      SendDatagram(url, "noise");
    }
    SendDatagram(url, "LC02\0\0\0\1LAST\0"s);
  });
  ASSERT_TRUE(socket.Wait(kLong));
  EXPECT_EQ(ChannelOf(socket), "LAST");
}

TEST(MessageSocketTest, HearsNoOtherGroupOnThePort) {
  const std::string url = runtime::FreshMulticastUrl();
  const std::uint16_t port = runtime::ParseMulticastUrl(url).value().port;
  const std::string other = "udpm://239.255.76.68:" + std::to_string(port);
  runtime::MessageSocket socket(url, {});
  const runtime::MessageSocket neighbour(other, {});
  SendDatagram(other, "LC02\0\0\0\1OTHER\0"s);
  SendDatagram(url, "LC02\0\0\0\1OWN\0"s);
  ASSERT_TRUE(socket.Wait(kLong));
  EXPECT_EQ(ChannelOf(socket), "OWN");
}

TEST(MessageSocketTest, SaysWhyItCannotBeOpened) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit none = before;
  none.rlim_cur = 0;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  int error = 0;
  try {
    const runtime::MessageSocket socket("udpm://239.255.76.67:23456", {});
  } catch (const std::system_error& failure) {
    error = failure.code().value();
  }
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(error, EMFILE);
}

}  // namespace
}  // namespace fogline::test
