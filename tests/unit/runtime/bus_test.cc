#include "services/runtime/bus.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenario/loader.h"

namespace fogline {
namespace {

std::vector<std::uint8_t> Payload(int number) { return {static_cast<std::uint8_t>(number)}; }

TEST(BusTest, KeepsABurstFarLongerThanTheQueueOfLcm) {
  for (const std::string& url : {std::string("memq://"), FreshMulticastUrl()}) {
    Bus bus(url);
    std::vector<int> received;
    bus.Subscribe("BURST", [&received](Bytes bytes) { received.push_back(bytes[0]); });
    constexpr int kBurst = 200;
    for (int i = 0; i < kBurst; ++i) bus.Publish("BURST", Payload(i));
    while (received.size() < kBurst && bus.Wait(std::chrono::seconds(5))) {
    }
    ASSERT_EQ(received.size(), kBurst) << url;
    for (int i = 0; i < kBurst; ++i) EXPECT_EQ(received[static_cast<std::size_t>(i)], i);
  }
}

TEST(BusTest, TakesChannelNamesLiterally) {
  Bus bus("memq://");
  int literal = 0;
  int other = 0;
  bus.Subscribe("A.C(1)", [&literal](Bytes) { ++literal; });
  bus.Subscribe("ABC", [&other](Bytes) { ++other; });
  bus.Publish("A.C(1)", Payload(0));
  bus.Publish("ABC", Payload(0));
  bus.Publish("ABC", Payload(0));
  bus.Drain();
  EXPECT_EQ(literal, 1);
  EXPECT_EQ(other, 2);
}

TEST(BusTest, WatchesEveryChannelWhateverElseItSubscribesTo) {
  const std::string url = FreshMulticastUrl();
  Bus sender(url);
  Bus bus(url);
  int subscribed = 0;
  std::vector<std::string> watched;
  bus.Subscribe("BEFORE", [&subscribed](Bytes) { ++subscribed; });
  bus.SubscribeAll([&watched](std::string_view channel, Bytes) { watched.emplace_back(channel); });
  bus.Subscribe("AFTER", [&subscribed](Bytes) { ++subscribed; });
  for (const char* channel : {"BEFORE", "OTHER", "AFTER", "LAST"}) {
    sender.Publish(channel, Payload(0));
  }
  while (std::ranges::find(watched, "LAST") == watched.end() && bus.Wait(std::chrono::seconds(5))) {
  }
  std::erase(watched, "LCM_SELF_TEST");
  EXPECT_EQ(watched, (std::vector<std::string>{"BEFORE", "OTHER", "AFTER", "LAST"}));
  EXPECT_EQ(subscribed, 2);
}

TEST(BusTest, HandsAnExceptionOfAHandlerToTheCallerOfWait) {
  Bus bus("memq://");
  bus.Subscribe("C", [](Bytes) { throw std::runtime_error("from the handler"); });
  bus.Publish("C", Payload(0));
  EXPECT_THROW(bus.Wait(std::chrono::seconds(1)), std::runtime_error);
  EXPECT_FALSE(bus.Wait(Duration::zero()));
}

TEST(BusTest, KeepsUdpmOnThisMachineUnlessToldOtherwise) {
  EXPECT_NE(Bus("udpm://239.255.76.67:23456").url().find("ttl=0"), std::string::npos);
  EXPECT_NE(FreshMulticastUrl(), FreshMulticastUrl());
}

TEST(BusTest, RefusesAUrlThatLcmCannotOpen) {
  EXPECT_THROW(Bus("nonsense"), InputError);
  EXPECT_THROW(Bus("nosuchprovider://"), InputError);
}

}  // namespace
}  // namespace fogline
