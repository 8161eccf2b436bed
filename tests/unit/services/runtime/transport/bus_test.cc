#include "services/runtime/transport/bus.h"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "common/errors.h"
#include "common/process/poll.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/unit/services/runtime/transport/raw_datagram.h"

namespace fogline {
namespace {

std::vector<std::uint8_t> Payload(int number) { return {static_cast<std::uint8_t>(number)}; }

constexpr Duration kLong = std::chrono::seconds(5);

/// Sends messages with the numbers from 0 on, beginning again after 255.
void SendBurst(runtime::Bus& bus, int count) {
  for (int i = 0; i < count; ++i) bus.Publish("BURST", Payload(i));
}

/// Waits until `count` messages are received, or until no message comes for `timeout`.
void ReceiveBurst(runtime::Bus& bus, const std::vector<int>& received, std::size_t count,
                  Duration timeout = kLong) {
  while (received.size() < count && bus.Wait(timeout)) {
  }
}

TEST(BusTest, KeepsABurstFarLongerThanTheQueueOfLcm) {
  runtime::Bus bus("memq://");
  std::vector<int> received;
  bus.Subscribe("BURST", [&received](runtime::Bytes bytes) { received.push_back(bytes[0]); });
  constexpr int kBurst = 200;
  SendBurst(bus, kBurst);
  ReceiveBurst(bus, received, kBurst);
  ASSERT_EQ(received.size(), kBurst);
  for (int i = 0; i < kBurst; ++i) EXPECT_EQ(received[static_cast<std::size_t>(i)], i);
}

TEST(BusTest, HasAReceiveBufferOfTheSizeInItsUrl) {
  constexpr int kBurst = 2000;
  runtime::Bus narrow(runtime::FreshMulticastUrl() + "&recv_buf_size=10000");
  std::vector<int> received;
  narrow.Subscribe("BURST", [&received](runtime::Bytes bytes) { received.push_back(bytes[0]); });
  SendBurst(narrow, kBurst);
  ReceiveBurst(narrow, received, kBurst, Duration::zero());
  EXPECT_GT(received.size(), 0U);
  EXPECT_LT(received.size(), 200U);
}

TEST(BusTest, TakesChannelNamesLiterally) {
  runtime::Bus bus("memq://");
  int literal = 0;
  int other = 0;
  bus.Subscribe("A.C(1)", [&literal](runtime::Bytes) { ++literal; });
  bus.Subscribe("ABC", [&other](runtime::Bytes) { ++other; });
  bus.Publish("A.C(1)", Payload(0));
  bus.Publish("ABC", Payload(0));
  bus.Publish("ABC", Payload(0));
  bus.Drain();
  EXPECT_EQ(literal, 1);
  EXPECT_EQ(other, 2);
}

std::ptrdiff_t Threads() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
}

TEST(BusTest, ReceivesWithoutAThreadUntilItKeepsABacklog) {
  const std::string url = runtime::FreshMulticastUrl();
  const std::ptrdiff_t before = Threads();
  std::optional<runtime::Bus> bus(url);
  std::vector<int> received;
  // A handler may call KeepBacklog(). The message that the handler processes stays valid.
  bus->Subscribe("C", [&](runtime::Bytes bytes) {
    if (bytes[0] == 1) bus->KeepBacklog();
    received.push_back(bytes[0]);
  });
  const std::int64_t replaced = bus->replaced();
  EXPECT_EQ(Threads(), before);
  for (int i = 1; i <= 3; ++i) bus->Publish("C", Payload(i));
  ReceiveBurst(*bus, received, 3);
  EXPECT_EQ(received, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(Threads(), before + 1);
  EXPECT_EQ(bus->replaced(), replaced + 1);
  EXPECT_EQ(PollFor(bus->fd(), POLLIN, Duration::zero()), 0);
  bus->Publish("C", Payload(4));
  EXPECT_EQ(PollFor(bus->fd(), POLLIN, kLong), 1);
  EXPECT_TRUE(bus->Wait(Duration::zero()));
  EXPECT_EQ(received.back(), 4);
  bus.reset();
  // The kernel may count a thread for a moment after it was joined, so the test waits.
  for (int i = 0; i < 1000 && Threads() > before; ++i) std::this_thread::sleep_for(milliseconds(5));
  EXPECT_EQ(Threads(), before);
}

TEST(BusTest, RefusesToWaitInAHandler) {
  for (const std::string faults : {"", "delay_ms=1"}) {
    runtime::Bus bus(runtime::FreshMulticastUrl());
    if (!faults.empty()) bus.Impair(runtime::Faults(runtime::ParseFaults(faults), Role::kRunner));
    int received = 0;
    bus.Subscribe("C", [&](runtime::Bytes) {
      if (++received == 1) bus.Wait(Duration::zero());
      if (received == 2) bus.Drain();
    });
    for (int i = 0; i < 3; ++i) bus.Publish("C", Payload(i));
    const auto handle_one = [&bus, &received] {
      const int before = received;
      for (int i = 0; i < 10 && received == before; ++i) bus.Wait(kLong);
    };
    EXPECT_THROW(handle_one(), std::logic_error) << faults;
    EXPECT_THROW(handle_one(), std::logic_error) << faults;
    EXPECT_NO_THROW(handle_one()) << faults;
    EXPECT_EQ(received, 3) << "the bus still works";
  }
}

TEST(BusTest, RefusesToWaitInAWatcher) {
  runtime::Bus bus(runtime::FreshMulticastUrl());
  bus.SubscribeAll([&bus](std::string_view, runtime::Bytes) { bus.Wait(Duration::zero()); });
  for (int i = 0; i < 2; ++i) bus.Publish("C", Payload(i));
  EXPECT_THROW(bus.Wait(kLong), std::logic_error);
}

TEST(BusTest, WatchesEveryChannelWhateverElseItSubscribesTo) {
  const std::string url = runtime::FreshMulticastUrl();
  runtime::Bus sender(url);
  runtime::Bus bus(url);
  int subscribed = 0;
  std::vector<std::string> watched;
  bus.Subscribe("BEFORE", [&subscribed](runtime::Bytes) { ++subscribed; });
  bus.SubscribeAll(
      [&watched](std::string_view channel, runtime::Bytes) { watched.emplace_back(channel); });
  bus.Subscribe("AFTER", [&subscribed](runtime::Bytes) { ++subscribed; });
  for (const char* channel : {"BEFORE", "OTHER", "AFTER", "LAST"}) {
    sender.Publish(channel, Payload(0));
  }
  while (std::ranges::find(watched, "LAST") == watched.end() && bus.Wait(std::chrono::seconds(5))) {
  }
  EXPECT_EQ(watched, (std::vector<std::string>{"BEFORE", "OTHER", "AFTER", "LAST"}));
  EXPECT_EQ(subscribed, 2);
}

TEST(BusTest, DropsFragmentsAlsoWhenItWatchesEveryChannel) {
  using namespace std::string_literals;
  const std::string url = runtime::FreshMulticastUrl();
  runtime::Bus bus(url);
  std::vector<std::string> watched;
  bus.SubscribeAll(
      [&watched](std::string_view channel, runtime::Bytes) { watched.emplace_back(channel); });
  // GIVEN a message of 4 bytes as one fragment, which LCM itself would accept
  test::SendDatagram(url, "LC03\0\0\0\1\0\0\0\4\0\0\0\0\0\0\0\1WHOLE\0abcd"s);
  test::SendDatagram(url, "LC02\0\0\0\2LAST\0abcd"s);
  while (std::ranges::find(watched, "LAST") == watched.end() && bus.Wait(std::chrono::seconds(5))) {
  }
  EXPECT_EQ(watched, std::vector<std::string>{"LAST"});
}

TEST(BusTest, HandsAnExceptionOfAHandlerToTheCallerOfWait) {
  runtime::Bus bus("memq://");
  bus.Subscribe("C", [](runtime::Bytes) { throw std::runtime_error("from the handler"); });
  bus.Publish("C", Payload(0));
  EXPECT_THROW(bus.Wait(std::chrono::seconds(1)), std::runtime_error);
  EXPECT_FALSE(bus.Wait(Duration::zero()));
}

TEST(BusTest, KeepsUdpmOnThisMachineUnlessToldOtherwise) {
  EXPECT_NE(runtime::Bus("udpm://239.255.76.67:23456").url().find("ttl=0"), std::string::npos);
  EXPECT_NE(runtime::FreshMulticastUrl(), runtime::FreshMulticastUrl());
}

runtime::SigningKey KeyOf(std::uint8_t byte) {
  runtime::SigningKey::Secret secret{};
  secret.fill(byte);
  return runtime::SigningKey(secret);
}

TEST(BusTest, SendsNothingThatDoesNotFitOneDatagram) {
  runtime::Bus bus("memq://");
  EXPECT_NO_THROW(bus.Publish("C", std::vector<std::uint8_t>(runtime::kMaxMessageBytes)));
  EXPECT_THROW(bus.Publish("C", std::vector<std::uint8_t>(runtime::kMaxMessageBytes + 1)),
               std::runtime_error);
}

TEST(BusTest, TakesSignedMessagesAloneOnceItHasAKeyAndCountsTheOthers) {
  const std::string url = runtime::FreshMulticastUrl();
  runtime::Bus receiver(url);
  receiver.Secure(runtime::MessageSigner(KeyOf(1), Role::kFusion));
  std::vector<int> received;
  receiver.Subscribe("RADAR", [&received](runtime::Bytes bytes) {
    EXPECT_EQ(bytes.size(), 1U);
    received.push_back(bytes[0]);
  });
  // GIVEN a sender without a key, a sender with another key, and a sender that has the key but may
  // not publish RADAR
  runtime::Bus keyless(url);
  runtime::Bus other(url);
  other.Secure(runtime::MessageSigner(KeyOf(2), Role::kRadar));
  runtime::Bus lidar(url);
  lidar.Secure(runtime::MessageSigner(KeyOf(1), Role::kLidar));
  runtime::Bus radar(url);
  radar.Secure(runtime::MessageSigner(KeyOf(1), Role::kRadar));
  for (int i = 0; i < 3; ++i) keyless.Publish("RADAR", Payload(1));
  for (int i = 0; i < 2; ++i) other.Publish("RADAR", Payload(2));
  lidar.Publish("RADAR", Payload(3));
  radar.Publish("RADAR", Payload(4));
  while (received.empty() && receiver.Wait(std::chrono::seconds(5))) {
  }
  EXPECT_EQ(received, std::vector<int>{4});
  EXPECT_EQ(receiver.unverified().not_signed, 3);
  EXPECT_EQ(receiver.unverified().badly_signed, 3);
  EXPECT_EQ(receiver.TakeUnverified().badly_signed, 3);
  EXPECT_EQ(receiver.TakeUnverified().badly_signed, 0);
  EXPECT_EQ(runtime::SignatureTrouble(receiver.unverified()),
            "3 messages with a wrong signature were refused: do all processes have the same key?");
}

TEST(BusTest, TakesNoKeyWhereNothingFiltersWhatReachesLcmsParser) {
  runtime::Bus bus("mpudpm://239.255.76.67:23457?ttl=0");
  EXPECT_THROW(bus.Secure(runtime::MessageSigner(KeyOf(1), Role::kFusion)), InputError);
}

TEST(BusTest, KnowsThatAKeyIsWanting) {
  const std::string url = runtime::FreshMulticastUrl();
  runtime::Bus keyless(url);
  bool heard = false;
  keyless.Subscribe("RADAR", [&heard](runtime::Bytes bytes) {
    heard = bytes.size() == 1 + runtime::kSignatureBytes;
  });
  runtime::Bus radar(url);
  radar.Secure(runtime::MessageSigner(KeyOf(1), Role::kRadar));
  EXPECT_EQ(runtime::SignatureTrouble(keyless.unverified()), "");
  radar.Publish("RADAR", Payload(4));
  EXPECT_TRUE(keyless.Wait(std::chrono::seconds(5)));
  EXPECT_TRUE(heard) << "it is for the decoder to refuse";
  EXPECT_EQ(runtime::SignatureTrouble(keyless.unverified()),
            "traffic on this network is signed; give --key");
}

TEST(BusTest, HandsLateMessagesOnWhenTheirTimeHasCome) {
  for (const std::string& url : {std::string("memq://"), runtime::FreshMulticastUrl()}) {
    runtime::Bus bus(url);
    bus.Impair(runtime::Faults({.delay_ms = 20}, Role::kAcc));
    int received = 0;
    bus.Subscribe("C", [&received](runtime::Bytes) { ++received; });
    const TimePoint began = Clock::now();
    bus.Publish("C", Payload(0));
    while (received == 0 && bus.Wait(std::chrono::seconds(5))) {
    }
    EXPECT_EQ(received, 1) << url;
    EXPECT_GE(Clock::now() - began, milliseconds(20)) << url;
    EXPECT_FALSE(bus.Wait(Duration::zero()));
  }
}

TEST(BusTest, LosesMessagesInMemoryWhenItIsToldTo) {
  runtime::Bus bus("memq://");
  bus.Impair(runtime::Faults({.loss = 0.5, .seed = 3}, Role::kAcc));
  int received = 0;
  bus.Subscribe("C", [&received](runtime::Bytes) { ++received; });
  for (int i = 0; i < 200; ++i) bus.Publish("C", Payload(0));
  bus.Drain();
  // The tolerance is five standard deviations.
  EXPECT_NEAR(received, 100, 36);
}

TEST(BusTest, RefusesAUrlThatLcmCannotOpen) {
  EXPECT_THROW(runtime::Bus("nonsense"), InputError);
  EXPECT_THROW(runtime::Bus(""), InputError);
  EXPECT_THROW(runtime::Bus("nosuchprovider://"), InputError);
  testing::internal::CaptureStderr();
  EXPECT_THROW(runtime::Bus("pigeon"), InputError);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "LCM prints nothing of its own";
}

/// The error of a bus with this URL; "" if there is none.
std::string RefusalOf(const std::string& url) {
  try {
    const runtime::Bus bus(url);
  } catch (const InputError& refused) {
    return refused.what();
  }
  return "";
}

TEST(BusTest, SaysWhyItCannotListen) {
  // GIVEN a program that lets no other socket have its port
  const int owner = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  ASSERT_EQ(bind(owner, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  socklen_t size = sizeof(address);
  getsockname(owner, reinterpret_cast<sockaddr*>(&address), &size);
  const std::string url = "udpm://239.255.76.67:" + std::to_string(ntohs(address.sin_port));
  const std::string error = RefusalOf(url);
  close(owner);
  EXPECT_EQ(error, "error: cannot listen to \"" + url + "?ttl=0\": Address already in use");
}

TEST(BusTest, RefusesAnOptionThatLcmWouldIgnore) {
  const std::string url = runtime::FreshMulticastUrl() + "&tll=1";
  EXPECT_EQ(
      RefusalOf(url),
      "error: " + url + ": udpm has no option \"tll\"; its options are ttl and recv_buf_size");
}

TEST(BusTest, NamesWhatIsWrongInTheUrlAsItIsGiven) {
  for (const std::string url :
       {"udpm://239.255.76.67:23456?", "udpm://239.255.76.67:23456?ttl=0&"}) {
    EXPECT_EQ(RefusalOf(url), "error: " + url + ": an option is missing at its end");
  }
}

TEST(BusTest, ReceivesMpudpmThroughLcm) {
  const std::string url = "mp" + runtime::FreshMulticastUrl();
  runtime::Bus bus(url);
  runtime::Bus sender(url);
  std::set<std::string> heard;
  bus.Subscribe("C", [&heard](runtime::Bytes) { heard.insert("C, subscribed"); });
  bus.SubscribeAll([&heard](std::string_view channel, runtime::Bytes) {
    if (!channel.starts_with("#!mpudpm")) heard.emplace(channel);
  });
  // With mpudpm, LCM learns the port of a channel only while it receives. So it may lose the first
  // messages, and the test sends them again.
  constexpr int kTries = 50;
  const std::set<std::string> all{"C", "C, subscribed", "OTHER"};
  for (int i = 0; i < kTries && heard != all; ++i) {
    sender.Publish("OTHER", Payload(0));
    sender.Publish("C", Payload(0));
    while (bus.Wait(milliseconds(100))) {
    }
  }
  EXPECT_EQ(heard, all);
  EXPECT_TRUE(bus.LcmReceives());
}

}  // namespace
}  // namespace fogline
