// Debian's own LCM programs on a run of Fogline: lcm-logger records the run, lcm-logplayer plays
// the log, and lcm-spy shows the messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <map>

#include "services/driver/driver.h"
#include "services/log/about/log_graph.h"
#include "services/log/event_log.h"
#include "services/log/log_seal.h"
#include "services/runtime/process/step_node.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/lcm/lcm_programs.h"

namespace fogline::test {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

using Payload = std::vector<std::uint8_t>;

/// The payloads of a log or a network by channel, in order of arrival.
using Traffic = std::map<std::string, std::vector<Payload>, std::less<>>;

Traffic ReadTraffic(const std::string& log) {
  Traffic traffic;
  log::EventLogReader reader(log);
  while (const auto event = reader.Next()) {
    traffic[std::string(event->channel)].emplace_back(event->data.begin(), event->data.end());
  }
  EXPECT_EQ(reader.torn(), "");
  return traffic;
}

/// Payloads by step. A step may have several messages, because lost messages are sent again. All
/// messages of a step must have the same bytes.
std::map<std::int64_t, Payload> BySteps(const std::vector<Payload>& payloads) {
  std::map<std::int64_t, Payload> steps;
  for (const Payload& payload : payloads) {
    const auto [at, is_new] =
        steps.emplace(runtime::ReadInt64(payload, runtime::kStepOffset), payload);
    EXPECT_TRUE(is_new || at->second == payload) << "two messages of step " << at->first;
  }
  return steps;
}

/// The parts of the scenario that RUN messages carry.
std::map<std::int64_t, std::string> ScenarioTexts(const std::vector<Payload>& payloads) {
  std::map<std::int64_t, std::string> parts;
  for (const Payload& payload : payloads) {
    run_t run{};
    EXPECT_TRUE(runtime::Decode(payload, run));
    parts[run.header.step] = run.text;
  }
  return parts;
}

/// Names of the message types, in the order of kChannels.
std::vector<std::string> TypeNames() {
  return std::apply(
      [](const auto&... channel) {
        return std::vector<std::string>{std::decay_t<decltype(channel)>::Message::getTypeName()...};
      },
      kGraph);
}

/// Removes the signatures from all messages of a run. Each message must have one.
void RemoveSignatures(Traffic& traffic) {
  for (const ChannelInfo& channel : kChannels) {
    const auto found = traffic.find(channel.name);
    if (found == traffic.end()) continue;
    for (Payload& payload : found->second) {
      ASSERT_TRUE(runtime::LooksSigned(payload)) << channel.name;
      payload.resize(payload.size() - runtime::kSignatureBytes);
    }
  }
}

/// Plays a log of signed traffic to a receiver that has the key. @return how many TRUTH messages
/// the receiver accepts
std::size_t PlayedAndVerified(const std::string& log, const std::string& key) {
  runtime::Bus bus(runtime::FreshMulticastUrl());
  bus.Secure(runtime::MessageSigner(runtime::SigningKey::Load(key), Role::kFusion));
  std::size_t truths = 0;
  bus.Subscribe("TRUTH", [&truths](runtime::Arrival& arrival) {
    truths += arrival.As<truth_t>() != nullptr ? 1 : 0;
  });
  Background player({"lcm-logplayer", "--speed=25", "--lcm-url=" + bus.url(), log});
  EXPECT_EQ(player.Wait(), 0) << player.Err();
  while (bus.Wait(milliseconds(200))) {
  }
  EXPECT_EQ(bus.unverified().badly_signed, 0);
  return truths;
}

// The driver waits for lcm-spy once in this number of steps. lcm-spy has then handled all messages
// so far. Between two such steps lcm-spy may lose messages if it gets no processor time.
constexpr std::int64_t kStepsOfSpy = 10;

/// The driver of a run. The driver answers for a step only after lcm-logger has written all earlier
/// messages. lcm-logger queues 30 messages, and lcm-spy queues as many as the buffer of its socket
/// holds. On a busy machine both programs lose the messages for which their queues have no room.
/// This driver makes the run wait, so the run sends fewer messages at a time.
class DriverThatWaits {
 public:
  DriverThatWaits(const std::string& url, const std::string& key, Logger& logger, Spy& spy)
      : bus_(url), logger_(logger), spy_(spy) {
    if (!key.empty())
      bus_.Secure(runtime::MessageSigner(runtime::SigningKey::Load(key), Role::kDriver));
    bus_.Subscribe("TRUTH", [this](runtime::Bytes truth) {
      begun_ = runtime::ReadInt64(truth, runtime::kStepOffset) + 1;
    });
    driver_.emplace(bus_, std::nullopt);
  }

  /// Takes part in one run of `steps` steps. @return false if the run takes too long
  [[nodiscard]] bool TakePart(std::int64_t steps) {
    std::int64_t waited = 0;
    auto end = Clock::now() + kPatience;  // the time limit of the next step
    runtime::Node& node = driver_->node();
    while (!node.parts().own.left() && Clock::now() < end) {
      const TimePoint now = Clock::now();
      bus_.Wait(std::min(node.Poll(now) - now, Duration(milliseconds(100))));
      if (begun_ <= waited || begun_ == steps) continue;
      waited = begun_;
      const std::string step = std::to_string(waited);
      if (!logger_.CatchUp("LOGGED_" + step)) return false;
      if (waited % kStepsOfSpy == 0 && !spy_.CatchUp("SHOWN_" + step)) return false;
      end = Clock::now() + kPatience;
    }
    return node.parts().own.left() && node.parts().own.message().error.empty();
  }

 private:
  runtime::Bus bus_;
  std::int64_t begun_ = 0;  // the number of steps that have begun
  std::optional<runtime::StepNode<driver::Driver>> driver_;
  Logger& logger_;
  Spy& spy_;
};

enum class Signing { kNone, kKey };
class LoggerAndSpyTest : public testing::TestWithParam<Signing> {};

TEST_P(LoggerAndSpyTest, GetAndDecodeTheMessagesOfARunThatLeavesThemTheTime) {
  // GIVEN lcm-logger and lcm-spy, both listening
  const ScratchFolder folder;
  const std::string key = GetParam() == Signing::kKey ? folder.File("key") : "";
  constexpr int kSteps = 40;
  const std::string own = folder.File("own.lcm");
  const std::string debian = folder.File("debian.lcm");
  runtime::Bus bus(runtime::FreshMulticastUrl());
  Logger logger(bus, debian);
  Spy spy(bus);
  ASSERT_TRUE(logger.CatchUp("BEFORE_LOG"));
  ASSERT_TRUE(spy.CatchUp("BEFORE")) << spy.Err();
  // WHEN a run takes place and its driver waits for both programs
  std::vector<std::string> command{Program("fogline"),
                                   "run",
                                   "scenario/paper.json",
                                   "--set",
                                   "/steps=" + std::to_string(kSteps),
                                   "--json",
                                   "--external",
                                   "driver",
                                   "--stall-timeout",
                                   "60",
                                   "--lcm-url",
                                   bus.url(),
                                   "--log",
                                   own};
  if (!key.empty()) {
    runtime::SigningKey::Create(key);
    command.insert(command.end(), {"--key", key});
  }
  Background run(command);
  ASSERT_TRUE(DriverThatWaits(bus.url(), key, logger, spy).TakePart(kSteps)) << run.Err();
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  ASSERT_TRUE(logger.CatchUp("AFTER_LOG"));
  ASSERT_TRUE(spy.CatchUp("AFTER")) << spy.Err();
  ASSERT_EQ(logger.End(), 0);
  // THEN lcm-logger has every message that our recorder has
  const Traffic recorded = ReadTraffic(own);
  Traffic logged = ReadTraffic(debian);
  if (!key.empty()) RemoveSignatures(logged);
  for (const ChannelInfo& channel : kChannels) {
    SCOPED_TRACE(channel.name);
    const auto expected = recorded.find(channel.name);
    ASSERT_EQ(expected != recorded.end(), channel.Logged());
    if (!channel.Logged()) continue;
    std::vector<Payload>& got = logged[std::string(channel.name)];
    if (channel.pace == Pace::kStep) {
      EXPECT_EQ(std::ssize(expected->second), kSteps);
      EXPECT_TRUE(BySteps(got) == BySteps(expected->second));
    } else {
      EXPECT_EQ(ScenarioTexts(got), ScenarioTexts(expected->second));
    }
  }
  // AND lcm-logger's log gives the same results as our log
  const Outcome metrics = RunCommand({Program("fogline"), "metrics", "--json", own, debian});
  ASSERT_EQ(metrics.code, 0) << metrics.err;
  const auto logs = nlohmann::json::parse(metrics.out);
  EXPECT_EQ(logs[1]["complete"], true);
  EXPECT_EQ(logs[1]["digest"], logs[0]["digest"]);
  EXPECT_EQ(logs[1]["metrics"], logs[0]["metrics"]);
  EXPECT_EQ(logs[0]["digest"], nlohmann::json::parse(run.Out())["digest"]);
  // AND lcm-spy shows every channel with its type. RESEND, DRIVER_INPUT and TRIAL are missing if no
  // process has sent a message on them.
  const auto rows = spy.Rows();
  const std::vector<std::string> types = TypeNames();
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    SCOPED_TRACE(kChannels[i].name);
    const std::string channel(kChannels[i].name);
    if (kChannels[i].pace == Pace::kControl && !logged.contains(channel)) continue;
    const auto row = rows.find(channel);
    ASSERT_NE(row, rows.end());
    EXPECT_EQ(row->second.type, types[i]);
    EXPECT_EQ(row->second.undecodable, 0);
    EXPECT_GE(row->second.messages, kChannels[i].pace == Pace::kStep ? kSteps / kStepsOfSpy : 1);
  }
  // AND the signatures in lcm-logger's log still hold when lcm-logplayer plays this log
  if (!key.empty()) {
    EXPECT_EQ(PlayedAndVerified(debian, key), logged["TRUTH"].size());
  }
}

INSTANTIATE_TEST_SUITE_P(LcmToolsTest, LoggerAndSpyTest,
                         testing::Values(Signing::kNone, Signing::kKey), [](const auto& signing) {
                           return signing.param == Signing::kKey ? "Signed" : "Unsigned";
                         });

TEST(LcmToolsTest, LogplayerPlaysEveryMessageToASubscriberThatDecodesIt) {
  // GIVEN a log, and a subscriber to every channel in it
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                                  "memq", "--quiet", "--log", log});
  ASSERT_EQ(run.code, 0) << run.err;
  runtime::Bus bus(runtime::FreshMulticastUrl());
  Traffic received;
  std::map<std::string, int> undecodable;
  const auto listen = [&]<class M>() {
    const std::string channel(ChannelOf<M>().name);
    bus.Subscribe(channel, [&received, &undecodable, channel](runtime::Bytes bytes) {
      received[channel].emplace_back(bytes.begin(), bytes.end());
      M message{};
      if (!runtime::Decode(bytes, message)) ++undecodable[channel];
    });
  };
  listen.operator()<run_t>();
  ForEachStepChannel([&]<class M>(std::size_t) { listen.template operator()<M>(); });
  bool ended = false;
  bus.Subscribe("END", [&ended](runtime::Bytes) { ended = true; });
  // WHEN lcm-logplayer plays the log 25 times as fast as the event times say (they span 50 s)
  Background player({"lcm-logplayer", "--speed=25", "--lcm-url=" + bus.url(), log});
  ASSERT_EQ(player.Wait(), 0) << player.Err();
  ASSERT_TRUE(Mark(bus, "END", [&] {
    bus.Drain();
    return ended;
  }));
  // THEN every message has arrived, in order, and decodes
  Traffic logged = ReadTraffic(log);
  EXPECT_EQ(logged.erase(std::string(log::kLogSealChannel)), 1U);   // no process sends a seal
  EXPECT_EQ(logged.erase(std::string(log::kLogGraphChannel)), 1U);  // no process sends a graph
  EXPECT_TRUE(received == logged);
  EXPECT_EQ(received["TRUTH"].size(), 500U);
  EXPECT_TRUE(undecodable.empty());
}

TEST(LcmToolsTest, LogplayerGuiPlaysALogAsFoglineStartsIt) {
  // GIVEN a log of three steps, and a subscriber
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                                  "direct", "--set", "/steps=3", "--quiet", "--log", log});
  ASSERT_EQ(run.code, 0) << run.err;
  runtime::Bus bus(runtime::FreshMulticastUrl());
  std::vector<Payload> truths;
  bus.Subscribe("TRUTH", [&truths](runtime::Bytes bytes) {
    truths.emplace_back(bytes.begin(), bytes.end());
  });
  // WHEN lcm-logplayer-gui opens the log THEN its messages arrive
  OwnScreen screen;
  Background player(
      {"env", screen.Setting(), Program("fogline"), "logplayer", log, "--lcm-url", bus.url()});
  const std::vector<Payload> logged = ReadTraffic(log)["TRUTH"];
  for (const auto end = Clock::now() + kPatience; truths.size() < logged.size();) {
    ASSERT_TRUE(IsAlive(player.pid()) && Clock::now() < end) << player.Err();
    bus.Wait(milliseconds(20));
    bus.Drain();
  }
  EXPECT_EQ(truths, logged);
}

}  // namespace
}  // namespace fogline::test
