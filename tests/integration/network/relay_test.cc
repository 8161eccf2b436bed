// fogline-relay with real programs, both ours and Debian's. (relay_clients_test.cc has clients that
// break the rules.)
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <thread>

#include <nlohmann/json.hpp>

#include "services/log/about/log_graph.h"
#include "services/log/event_log.h"
#include "services/log/log_seal.h"
#include "tests/integration/network/relay_fixture.h"

namespace fogline::test {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

std::vector<std::string> RunCommandLine(const std::string& transport, const std::string& log) {
  return {Program("fogline"),
          "run",
          "scenario/paper.json",
          "--json",
          "--transport",
          transport,
          "--log",
          log};
}

std::string DigestOf(const Outcome& run) {
  EXPECT_EQ(run.code, 0) << run.err;
  const auto document = nlohmann::json::parse(run.out, nullptr, false);
  return document.is_object() ? document["digest"].get<std::string>() : "";
}

// ---- messages ----------------------------------------------------------------------------------

TEST(RelayTest, GivesAPublisherItsOwnMessagesOnceAndInOrder) {
  Relay relay;
  runtime::Bus bus(relay.url());
  std::vector<std::uint8_t> heard;
  bus.Subscribe("A", [&](runtime::Bytes bytes) { heard.push_back(bytes[0]); });
  for (std::uint8_t i = 0; i < 100; ++i) bus.Publish("A", Payload{i});
  bus.Publish("B", Payload{0});
  ASSERT_TRUE(RoundTrip(bus));
  ASSERT_EQ(heard.size(), 100U);
  EXPECT_TRUE(std::ranges::is_sorted(heard));
}

// A role subscribes to further channels when the RUN with the scenario comes.
TEST(RelayTest, LetsAHandlerSubscribe) {
  Relay relay;
  runtime::Bus bus(relay.url());
  std::vector<std::string> heard;
  bus.Subscribe("FIRST", [&](runtime::Bytes) {
    heard.emplace_back("FIRST");
    if (heard.size() > 1) return;
    for (int i = 0; i < 40; ++i) {
      const std::string other = "OTHER" + std::to_string(i);
      bus.Subscribe(other, [&heard, other](runtime::Bytes) { heard.push_back(other); });
    }
  });
  for (const char* channel : {"FIRST", "OTHER39", "FIRST"}) {
    bus.Publish(channel, Payload(1));
    ASSERT_TRUE(RoundTrip(bus));
  }
  EXPECT_THAT(heard, testing::ElementsAre("FIRST", "OTHER39", "FIRST"));
}

TEST(RelayTest, TakesAndGivesMessagesOfStockLcm) {
  // GIVEN LCM's own client, which subscribes to everything
  Relay relay;
  lcm_t* stock = lcm_create(relay.url().c_str());
  ASSERT_NE(stock, nullptr);
  std::map<std::string, std::size_t> got;
  lcm_subscription_t* all = lcm_subscribe(
      stock, ".*",
      [](const lcm_recv_buf_t* buffer, const char* channel, void* user) {
        (*static_cast<std::map<std::string, std::size_t>*>(user))[channel] = buffer->data_size;
      },
      &got);
  // WHEN this client publishes, THEN it receives its own message
  const Payload large(100'000, 7);
  ASSERT_EQ(lcm_publish(stock, "FROM_STOCK", large.data(), static_cast<unsigned>(large.size())), 0);
  ASSERT_GT(lcm_handle_timeout(stock, 20'000), 0);
  EXPECT_EQ(got["FROM_STOCK"], large.size());
  // AND the client receives our messages
  runtime::Bus bus(relay.url());
  bus.Publish("FROM_OURS", Payload(5));
  ASSERT_GT(lcm_handle_timeout(stock, 20'000), 0);
  EXPECT_EQ(got["FROM_OURS"], 5U);
  // AND after this client has unsubscribed, only our bus receives the client's message. Before the
  // client unsubscribes, it receives all messages that are still in transit
  std::size_t heard = 0;
  bus.Subscribe("LAST", [&heard](runtime::Bytes bytes) { heard = bytes.size(); });
  ASSERT_TRUE(RoundTrip(bus));
  ASSERT_GT(lcm_handle_timeout(stock, 20'000), 0);
  ASSERT_EQ(got.size(), 3U);
  lcm_unsubscribe(stock, all);
  ASSERT_EQ(lcm_publish(stock, "LAST", large.data(), 3), 0);
  const TimePoint end = Clock::now() + kPatience;
  while (heard == 0 && Clock::now() < end) bus.Wait(milliseconds(100));
  EXPECT_EQ(heard, 3U);
  EXPECT_EQ(lcm_handle_timeout(stock, 0), 0);
  lcm_destroy(stock);
}

TEST(RelayTest, CarriesABurstToAPublisherThatOnlyReadsAfterwards) {
  // GIVEN a relay whose queue has less room than the burst needs, even together with the buffers of
  // the sockets of relay and bus
  Relay relay({"--max-queue", "4", "--quiet"});
  runtime::Bus bus(relay.url());
  int heard = 0;
  bus.Subscribe("BURST", [&heard](runtime::Bytes) { ++heard; });
  // WHEN the whole burst is published without a pause
  const Payload payload(1000, 1);
  constexpr int kMessages = 20'000;
  for (int i = 0; i < kMessages; ++i) bus.Publish("BURST", payload);
  // THEN no process blocks, and every message comes back
  ASSERT_TRUE(RoundTrip(bus));
  EXPECT_EQ(heard, kMessages);
}

TEST(RelayTest, SaysWhereItListensAndWhatItHasDoneAndNamesAPortThatIsTaken) {
  Relay relay;
  EXPECT_EQ(relay.url(), "tcpq://127.0.0.1:" + std::to_string(relay.port()));
  const std::string here = "127.0.0.1:" + std::to_string(relay.port());
  const Outcome second = RunCommand({Program("fogline-relay"), "--listen", here});
  EXPECT_EQ(second.code, 2);
  EXPECT_EQ(second.err, "fogline-relay: error: --listen: cannot listen on " + here +
                            ": Address already in use\n");
  EXPECT_THAT(RunCommand({Program("fogline-relay"), "--help"}).out,
              HasSubstr("2 bad usage, an address of another machine, or a port that it"));
  EXPECT_EQ(RunCommand({Program("fogline-relay"), "--listen", "nowhere"}).code, 2);
  const Outcome unwritten =
      RunCommand({"sh", "-c", Program("fogline-relay") + " --listen 127.0.0.1:0 > /dev/full"});
  EXPECT_EQ(unwritten.code, 3);
  EXPECT_THAT(unwritten.err, HasSubstr("cannot write the URL: No space left on device"));
  // RFC 5737 reserves 203.0.113.0/24 for examples, so no machine has an address of it.
  const Outcome foreign = RunCommand({Program("fogline-relay"), "--listen", "203.0.113.7"});
  EXPECT_EQ(foreign.code, 2);
  EXPECT_THAT(foreign.err, HasSubstr("203.0.113.7 is no address of this machine"));
  {
    runtime::Bus bus(relay.url());
    bus.Publish("A", Payload(1));
    ASSERT_TRUE(RoundTrip(bus));
  }
  relay.process().Signal(SIGTERM);
  EXPECT_EQ(relay.process().Wait(), 0);
  EXPECT_THAT(relay.process().Err(),
              HasSubstr("1 clients, 0 disconnected; 2 messages in (0.0 MB), 1 out"));
}

// ---- a missing relay ---------------------------------------------------------------------------

TEST(RelayTest, IsMissedByNameOfItsAddress) {
  const auto end_of = [](const std::string& url) {
    const ScratchFolder folder;
    return RunCommand(RunCommandLine(url, folder.File("run.lcm")));
  };
  std::string url;
  {
    Relay relay;
    url = relay.url();
  }
  const Outcome refused = end_of(url);
  EXPECT_EQ(refused.code, 3);
  EXPECT_EQ(refused.err, "fogline run: error: no process listens on " + url.substr(7) +
                             "; start fogline-relay there\n");
  const Outcome unknown = end_of("tcpq://no-such-host.invalid:7700");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("no IPv4 address for \"no-such-host.invalid\""));
  EXPECT_EQ(std::ranges::count(unknown.err, '\n'), 1) << unknown.err;
}

TEST(RelayTest, IsLostOnceAndThenTheBusKeepsStill) {
  Relay relay;
  runtime::Bus bus(relay.url());
  ASSERT_TRUE(RoundTrip(bus));
  relay.process().Signal(SIGKILL);
  relay.process().Wait();
  try {
    const TimePoint end = Clock::now() + kPatience;
    while (Clock::now() < end) bus.Wait(milliseconds(100));
    FAIL() << "not noticed";
  } catch (const runtime::tcpq::ConnectionLost& lost) {
    EXPECT_THAT(lost.what(), HasSubstr("lost the relay " + relay.url() + ": "));
  }
  bus.Publish("A", Payload(1));
  EXPECT_FALSE(bus.Wait(milliseconds(1)));
}

TEST(RelayTest, IsFoundAgainWhereItWasByItsSubscribers) {
  const auto relay = std::make_unique<Relay>();
  const std::string url = relay->url();
  runtime::Bus bus(url);
  runtime::Bus other(url);
  int heard = 0;
  bus.Subscribe("A", [&heard](runtime::Bytes) { ++heard; });
  ASSERT_TRUE(RoundTrip(bus));
  // GIVEN a relay that is killed. Messages are lost, and the sender counts them
  relay->process().Signal(SIGKILL);
  relay->process().Wait();
  const TimePoint end = Clock::now() + kPatience;
  while (other.failed_sends().count == 0 && Clock::now() < end) other.Publish("A", Payload(1));
  EXPECT_THAT(other.failed_sends().error, HasSubstr("lost the relay " + url + ": "));
  EXPECT_TRUE(other.failed_sends().since);
  // WHEN another relay listens on the same port
  Background next({Program("fogline-relay"), "--listen", url.substr(7)});
  // THEN the relay carries messages again
  heard = 0;
  while (heard == 0 && Clock::now() < end) {
    other.Publish("A", Payload(1));
    other.Wait(milliseconds(1));
    bus.Wait(milliseconds(1));
  }
  EXPECT_GT(heard, 0);
  EXPECT_FALSE(other.failed_sends().since);
  EXPECT_TRUE(RoundTrip(other));
}

// ---- runs --------------------------------------------------------------------------------------

TEST(RelayTest, CarriesTwoRunsAtOnceThatDoNotMix) {
  const ScratchFolder folder;
  Relay relay;
  const Outcome alone = RunCommand(RunCommandLine("direct", folder.File("alone.lcm")));
  auto command = RunCommandLine(relay.url(), folder.File("one.lcm"));
  Background one(command);
  const Outcome two = RunCommand(RunCommandLine(relay.url(), folder.File("two.lcm")));
  const int code = one.Wait();
  const std::string expected = DigestOf(alone);
  EXPECT_EQ(DigestOf({code, one.Out(), one.Err()}), expected);
  EXPECT_EQ(DigestOf(two), expected);
}

TEST(RelayTest, EndsARunWithOneClearLineWhenItIsKilled) {
  const ScratchFolder folder;
  Relay relay;
  std::vector<std::string> command = RunCommandLine(relay.url(), folder.File("run.lcm"));
  command.insert(command.end(), {"--pace", "1", "--quiet"});
  Background run(command);
  // GIVEN a run that is well under way
  ASSERT_TRUE(GrowsTo(20'000, folder.File("run.lcm")));
  // WHEN its relay is killed
  relay.process().Signal(SIGKILL);
  // THEN the run ends with code 3 and names the relay, and its log is readable
  EXPECT_EQ(run.Wait(), 3);
  EXPECT_THAT(run.Err(), HasSubstr("lost the relay " + relay.url()));
  EXPECT_EQ(RunCommand({Program("fogline"), "digest", folder.File("run.lcm")}).code, 1);
}

TEST(RelayTest, LetsLcmLoggerRecordEveryMessageOfARunInRealSpeed) {
  // GIVEN Debian's lcm-logger on the relay
  const ScratchFolder folder;
  const std::string stock = folder.File("stock.lcm");
  Relay relay;
  Background logger(
      {"lcm-logger", "--quiet", "--flush-interval=10", "--lcm-url=" + relay.url(), stock});
  runtime::Bus bus(relay.url());
  const auto caught_up = [&](const std::string& mark) {
    const TimePoint end = Clock::now() + kPatience;
    while (Clock::now() < end) {
      bus.Publish(mark, Payload(runtime::kHeaderEnd));
      bus.Wait(milliseconds(20));
      std::ifstream in(stock, std::ios::binary);
      std::ostringstream content;
      content << in.rdbuf();
      if (content.str().find(mark) != std::string::npos) return true;
    }
    return false;
  };
  ASSERT_TRUE(caught_up("BEFORE"));
  // WHEN a run takes place
  std::vector<std::string> command = RunCommandLine(relay.url(), folder.File("own.lcm"));
  command.insert(command.end(), {"--pace", "1", "--set", "/steps=30"});
  const std::string digest = DigestOf(RunCommand(command));
  ASSERT_TRUE(caught_up("AFTER"));
  logger.Signal(SIGINT);
  ASSERT_EQ(logger.Wait(), 0);
  // THEN lcm-logger's log is a log of the whole run
  const Outcome check = RunCommand({Program("fogline"), "digest", "--json", stock});
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr(digest));
  // AND lcm-logger's log has every payload of our own log
  const auto payloads = [](const std::string& log) {
    std::multimap<std::string, Payload> all;
    log::EventLogReader reader(log);
    while (const auto event = reader.Next()) {
      all.emplace(event->channel, Payload(event->data.begin(), event->data.end()));
    }
    return all;
  };
  const auto logged = payloads(stock);
  for (const auto& [channel, payload] : payloads(folder.File("own.lcm"))) {
    // The test leaves out three channels. On RUN, our log has only one message, in another phase.
    // The graph and the seal are only in our log, because no process sends them.
    if (channel == ChannelOf<run_t>().name || channel == log::kLogGraphChannel ||
        channel == log::kLogSealChannel) {
      continue;
    }
    const auto [first, last] = logged.equal_range(channel);
    EXPECT_TRUE(std::any_of(first, last, [&](const auto& it) { return it.second == payload; }))
        << channel << ", step " << runtime::ReadInt64(payload, runtime::kStepOffset);
  }
}

}  // namespace
}  // namespace fogline::test
