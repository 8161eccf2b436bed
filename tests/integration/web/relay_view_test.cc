// `fogline view` on the network of a relay that ends and comes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "services/runtime/transport/bus.h"
#include "tests/integration/network/relay_fixture.h"
#include "tests/integration/web/viewed.h"

namespace fogline::test {
namespace {

using nlohmann::json;

/// Publishes on a channel until the server tells the client that this channel exists.
/// @return false if this takes longer than kFrameLimit
bool Hears(WebClient& client, const std::string& url, const std::string& channel) {
  runtime::Bus bus(url);
  const TimePoint end = Clock::now() + kFrameLimit;
  while (Clock::now() < end) {
    bus.Publish(channel, Payload(10));
    const WebFrame frame = client.Receive();  // if nothing else comes, a health message
    if (frame.binary) continue;
    const json text = json::parse(frame.bytes);
    if (text["op"] == "channel" && text["name"] == channel) return true;
  }
  return false;
}

TEST(RelayViewTest, NeedsHardlyAnyProcessorTimeWhileTheRelayIsAwayAndThenGoesOn) {
  Relay relay;
  Viewed viewed({"--lcm-url", relay.url()});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  ASSERT_TRUE(Hears(client, relay.url(), "BEFORE"));
  relay.process().Signal(SIGKILL);
  relay.process().Wait();
  // The test measures the processor time in a pause of at least 2 s.
  const TimePoint began = Clock::now();
  const double before_s = ProcessorTime_s(viewed.process().pid());
  std::this_thread::sleep_for(milliseconds(2000));
  const double away_s = Seconds(Clock::now() - began);
  const double needed_s = ProcessorTime_s(viewed.process().pid()) - before_s;
  EXPECT_LT(needed_s, 0.1 * away_s);
  Background again(
      {Program("fogline-relay"), "--listen", "127.0.0.1:" + std::to_string(relay.port())});
  ASSERT_TRUE(again.WaitForOut("\n")) << again.Err();
  EXPECT_TRUE(Hears(client, relay.url(), "AFTERWARDS"));
  EXPECT_EQ(viewed.End(), 0);
}

TEST(RelayViewTest, AnswersItsClientsWhileTheRelayDoesNotAnswer) {
  namespace asio = boost::asio;
  Relay relay;
  Viewed viewed({"--lcm-url", relay.url()});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  ReceiveOp(client, "hello");
  // For comparison, the test also has a viewer whose relay answers.
  Relay answering;
  Viewed beside({"--lcm-url", answering.url()});
  ASSERT_NE(beside.port(), 0) << beside.process().Err();
  WebClient reference(beside.port());
  ReceiveOp(reference, "hello");
  const auto answer_s = [](WebClient& asker) {
    const TimePoint asked = Clock::now();
    asker.Send("{}");
    ReceiveOp(asker, "error");
    return Seconds(Clock::now() - asked);
  };
  const auto median_s = [](std::vector<double> took_s) {
    std::ranges::sort(took_s);
    return took_s[took_s.size() / 2];
  };
  const auto slower = [&] {
    std::vector<double> took_s;
    std::vector<double> reference_s;
    for (int i = 0; i < 20; ++i) {
      took_s.push_back(answer_s(client));
      reference_s.push_back(answer_s(reference));
      std::this_thread::sleep_for(
          milliseconds(70));  // so that the requests meet all phases of a try to connect
    }
    return median_s(took_s) - median_s(reference_s);
  };
  relay.process().Signal(SIGKILL);
  relay.process().Wait();
  // The relay is replaced by a socket that accepts connections and never answers.
  asio::io_context context;
  const asio::ip::tcp::acceptor silent(context, {asio::ip::address_v4::loopback(), relay.port()});
  // If each try to connect blocked the program for 200 ms, most answers would come only after the
  // try. Other programs may also make the answers slow, so the test measures in several rounds. A
  // program that is blocked is slow in each round.
  constexpr int kRounds = 5;
  double slower_s = 1;
  for (int i = 0; i < kRounds && slower_s >= 0.03; ++i) slower_s = slower();
  EXPECT_LT(slower_s, 0.03);
}

}  // namespace
}  // namespace fogline::test
