// The senders in `fogline top`: how many of their messages were lost, by LCM's own numbers.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/verbs/find_in_json.h"
#include "tests/integration/verbs/top_process.h"
#include "tests/support/numbered_sender.h"

namespace fogline::test {
namespace {

using nlohmann::json;

/// The sender that has sent on this channel.
json SenderOn(const json& document, const std::string& channel) {
  for (const json& sender : document["senders"]) {
    for (const json& heard : sender["channels"]) {
      if (heard == channel) return sender;
    }
  }
  ADD_FAILURE() << "no sender has sent on " << channel << " in " << document["senders"];
  return {};
}

TEST(TopSendersTest, TellsTheSenderThatLosesMessagesFromTheOneThatDoesNot) {
  runtime::Bus bus(runtime::FreshMulticastUrl());
  const NumberedSender camera(bus.url());
  Top top(bus);
  ASSERT_TRUE(top.CatchUp("BEFORE"));
  for (std::uint32_t number = 0; number < 100; ++number) {
    if (number == 10 || number == 11 || number == 50) continue;
    camera.Send(number, "CAMERA");
  }
  ASSERT_TRUE(top.CatchUp("AFTER"));
  const json document = top.Last();
  EXPECT_EQ(document["own_overflow"], 0);
  const json lossy = SenderOn(document, "CAMERA");
  EXPECT_EQ(lossy["address"], camera.Address());
  EXPECT_EQ(lossy["received"], 97);
  EXPECT_EQ(lossy["lost"], 3);
  EXPECT_EQ(lossy["channels"], json({"CAMERA"}));
  // The sender on the channel AFTER is a real LCM instance, and has lost nothing.
  const json whole = SenderOn(document, "AFTER");
  EXPECT_GE(whole["received"], 2);
  for (const char* count : {"lost", "missed_here", "late", "duplicates", "stray", "restarts"}) {
    EXPECT_EQ(whole[count], 0) << count;
  }
}

TEST(TopSendersTest, SaysThatARelaysMessagesHaveNoNumbers) {
  Background relay({Program("fogline-relay"), "--listen", "127.0.0.1:0"});
  ASSERT_TRUE(relay.WaitForOut("\n")) << relay.Err();
  runtime::Bus bus(relay.Out().substr(0, relay.Out().find('\n')));
  Top top(bus);
  ASSERT_TRUE(top.CatchUp("BEFORE"));
  EXPECT_TRUE(top.Last()["senders"].is_null());
}

TEST(TopSendersTest, FollowsTheSendersOfAWholeRunWithoutLoss) {
  runtime::Bus bus(runtime::FreshMulticastUrl());
  Top top(bus);
  ASSERT_TRUE(top.CatchUp("BEFORE"));
  const ScratchFolder folder;
  const Outcome run =
      RunCommand({Program("fogline"), "run", "scenario/paper.json", "--set", "/steps=100",
                  "--quiet", "--log", folder.File("run.lcm"), "--lcm-url", bus.url()});
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_TRUE(top.CatchUp("AFTER"));
  const json document = top.Last();
  for (const char* channel : {"TRUTH", "RADAR", "LIDAR", "TRACK", "HOST_COMMAND"}) {
    const json sender = SenderOn(document, channel);
    EXPECT_GE(sender["received"], 100) << channel;
    EXPECT_EQ(sender["lost"], 0) << channel;
  }
}

}  // namespace
}  // namespace fogline::test
