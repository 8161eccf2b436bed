// `fogline view` on a network: its clients get the same messages as the log of the run, and do not
// disturb the run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>

#include <map>
#include <set>
#include <thread>

#include "services/log/run_log.h"
#include "services/log/step_order.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/web/viewed.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::vector<std::string> RunOn(const std::string& url, const std::string& log, int steps,
                               const std::string& pace) {
  return {Program("fogline"),
          "run",
          "scenario/paper.json",
          "--lcm-url",
          url,
          "--log",
          log,
          "--set",
          "/steps=" + std::to_string(steps),
          "--pace",
          pace,
          "--json",
          "--quiet"};
}

/// The messages of a run that a client has received, by step and channel.
class Got {
 public:
  /// Takes the messages of a frame. Equal messages of one step and channel may come several times.
  void Take(const WebFrame& frame) {
    if (KindOf(frame) != 1) return;
    for (WebMessage& message : MessagesOf(frame)) {
      in_order_ = in_order_ && message.wall_ms >= wall_ms_;
      wall_ms_ = message.wall_ms;
      const auto place = static_cast<std::size_t>(message.channel);
      if (place >= kNumChannels || kChannels[place].pace != Pace::kStep) continue;
      const std::int64_t step = runtime::ReadInt64(BytesOf(message.bytes), runtime::kStepOffset);
      const auto [at, fresh] = messages_.emplace(std::pair(step, place), message.bytes);
      EXPECT_TRUE(fresh || at->second == message.bytes) << "step " << step;
    }
  }
  std::size_t size() const { return messages_.size(); }
  /// Whether the messages came in the order in which the program had received them.
  bool in_order() const { return in_order_; }
  const std::string& Of(std::int64_t step, std::size_t channel) {
    return messages_[std::pair(step, channel)];
  }

 private:
  std::map<std::pair<std::int64_t, std::size_t>, std::string> messages_;
  double wall_ms_ = 0;
  bool in_order_ = true;
};

/// Takes frames of a live view until `got` has this number of messages, or until kPatience has
/// passed.
void TakeUntil(std::size_t messages, WebClient& client, Got& got) {
  const TimePoint end = Clock::now() + kPatience;
  while (got.size() < messages && Clock::now() < end) got.Take(client.Receive(kPatience));
  EXPECT_TRUE(got.in_order());
}

/// Compares the received messages with the log of the run. @return the number of messages in the
/// log
std::size_t CompareWithLog(Got& got, const std::string& log) {
  log::RunLogReader reader(log);
  std::size_t messages = 0;
  for (std::int64_t step = 0; const log::StepMessages* expected = reader.Next(); ++step) {
    for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
      if ((*expected)[channel].empty()) continue;
      ++messages;
      EXPECT_TRUE(std::ranges::equal(BytesOf(got.Of(step, channel)), (*expected)[channel]))
          << "step " << step << ", " << kChannels[channel].name;
    }
  }
  return messages;
}

TEST(LiveViewTest, GivesEachMessageAsTheRunLogsIt) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  Viewed viewed({"--lcm-url", url});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  const json hello = ReceiveOp(client, "hello");
  EXPECT_EQ(hello["mode"], "live");
  EXPECT_EQ(hello["follows"], false);
  EXPECT_EQ(hello["waits_for_person"], false);
  EXPECT_THAT(hello["url"].get<std::string>(), HasSubstr(url));
  constexpr int kSteps = 230;  // fog begins at step 190, the human drives from step 203 on
  constexpr std::size_t kMessages = kSteps * log::kStepChannels;
  Background run(RunOn(url, folder.File("run.lcm"), kSteps, "10"));
  Got got;
  json described;
  std::vector<json> events;
  const TimePoint end = Clock::now() + kPatience;
  while (got.size() < kMessages && Clock::now() < end) {
    const WebFrame frame = client.Receive(kPatience);
    got.Take(frame);
    if (frame.binary) continue;
    const json text = json::parse(frame.bytes);
    if (text["op"] == "run") described = text;
    if (text["op"] == "event") events.push_back(text);
  }
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_TRUE(got.in_order());
  EXPECT_EQ(CompareWithLog(got, folder.File("run.lcm")), kMessages);
  EXPECT_EQ(described["steps"], kSteps);
  EXPECT_EQ(described["pace"], 10.0);
  EXPECT_EQ(described["scenario"]["steps"], kSteps);
  std::set<std::pair<std::string, int>> kinds;
  for (const json& event : events) kinds.emplace(event["kind"], event["step"]);
  EXPECT_TRUE(kinds.contains({"fog", 190})) << json(events).dump();
  EXPECT_TRUE(kinds.contains({"transfer", 203})) << json(events).dump();
  EXPECT_EQ(viewed.End(), 0);
}

TEST(LiveViewTest, GivesALateClientTheRunAndItsHistory) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  Viewed viewed({"--lcm-url", url});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  Background run(RunOn(url, folder.File("run.lcm"), 60, "0"));
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  WebClient client(viewed.port());
  EXPECT_EQ(ReceiveOp(client, "run")["steps"], 60);
  // On a busy machine the last messages of the run may reach the program, and then the client, only
  // now. So these messages may come before the frames of the history. Then the client asks for the
  // history again.
  constexpr std::size_t kMessages = 60 * 9;
  constexpr int kTries = 10;
  Got got;
  std::int64_t messages = 0;
  std::int64_t said = -1;
  for (int id = 5;
       id < 5 + kTries && (said != messages || got.size() != kMessages || !got.in_order()); ++id) {
    if (said >= 0) std::this_thread::sleep_for(milliseconds(100));
    client.Send(json{{"op", "history"}, {"id", id}}.dump());
    got = Got();
    messages = 0;
    for (json text = json::object(); text.value("op", "") != "history";) {
      const WebFrame frame = client.Receive(kPatience);
      got.Take(frame);
      if (KindOf(frame) == 1) messages += std::ssize(MessagesOf(frame));
      text = frame.binary ? json::object() : json::parse(frame.bytes);
      if (text.value("op", "") != "history") continue;
      EXPECT_EQ(text["id"], id);
      said = text["messages"];
    }
  }
  EXPECT_EQ(said, messages);
  EXPECT_TRUE(got.in_order());
  EXPECT_EQ(CompareWithLog(got, folder.File("run.lcm")), kMessages);
}

TEST(LiveViewTest, TellsTheScenarioToAViewerThatStartsLate) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  Background run(RunOn(url, folder.File("run.lcm"), 500, "1"));
  runtime::Bus bus(url);
  bool under_way = false;
  bus.Subscribe(ChannelOf<arbitration_t>().name, [&](runtime::Bytes) { under_way = true; });
  const TimePoint end = Clock::now() + kPatience;
  while (!under_way && Clock::now() < end) bus.Wait(milliseconds(100));
  ASSERT_TRUE(under_way) << run.Err();
  // WHEN a viewer connects after the beginning, and sends no request
  Viewed viewed({"--lcm-url", url});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  EXPECT_EQ(ReceiveOp(client, "run")["scenario"]["steps"], 500);
  run.Signal(SIGINT);
  run.Wait();
}

TEST(LiveViewTest, NamesChannelsOfOtherPrograms) {
  const std::string url = runtime::FreshMulticastUrl();
  Viewed viewed({"--lcm-url", url});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  ReceiveOp(client, "hello");
  runtime::Bus bus(url);
  const std::vector<std::uint8_t> noise{1, 2, 3};
  bus.Publish("CAMERA", noise);
  const json channel = ReceiveOp(client, "channel");
  EXPECT_EQ(channel["id"], kNumChannels);
  EXPECT_EQ(channel["type"], nullptr);
  EXPECT_EQ(channel["name"], "CAMERA");
  const auto messages = MessagesOf(ReceiveKind(client, 1));
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].channel, kNumChannels);
  EXPECT_EQ(messages[0].bytes, "\1\2\3");
  json health = ReceiveOp(client, "health");
  EXPECT_EQ(health["traffic"]["others"].size(), 1U);
  ASSERT_EQ(health["senders"].size(), 1U) << health["senders"].dump();
  EXPECT_GE(health["senders"][0]["received"], 1);  // LCM tests itself with a message, too
  EXPECT_EQ(health["senders"][0]["lost"], 0);
  WebClient late(viewed.port());
  EXPECT_EQ(ReceiveOp(late, "hello")["channels"].size(), kNumChannels + 1);
}

TEST(LiveViewTest, NamesMessagesThatAreLargerThanADatagram) {
  const std::string url = runtime::FreshMulticastUrl();
  Viewed viewed({"--lcm-url", url});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  lcm_t* lcm = lcm_create(url.c_str());
  ASSERT_NE(lcm, nullptr);
  const std::vector<std::uint8_t> picture(100'000, 1);
  EXPECT_EQ(lcm_publish(lcm, "CAMERA", picture.data(), static_cast<unsigned>(picture.size())), 0);
  lcm_destroy(lcm);
  json health;
  const TimePoint end = Clock::now() + kPatience;
  do {
    health = ReceiveOp(client, "health");
  } while (health["too_large"] == 0 && Clock::now() < end);
  EXPECT_EQ(health["too_large"], 1);
  EXPECT_EQ(health["too_large_channels"], json::array({"CAMERA"}));
  EXPECT_TRUE(viewed.process().WaitForErr("1 messages are larger than a datagram (CAMERA)"));
}

TEST(LiveViewTest, LeavesTheDigestOfARunAsItIsWith20Viewers) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  const json direct =
      json::parse(RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                              "direct", "--set", "/steps=150", "--json", "--quiet"})
                      .out);
  Viewed viewed({"--lcm-url", url});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  std::vector<WebClient> clients;
  for (int i = 0; i < 20; ++i) clients.emplace_back(viewed.port());
  Background run(RunOn(url, folder.File("run.lcm"), 150, "10"));
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_EQ(json::parse(run.Out())["digest"], direct["digest"]);
  for (WebClient& client : clients) {
    Got got;
    TakeUntil(150U * 9, client, got);
    EXPECT_EQ(CompareWithLog(got, folder.File("run.lcm")), 150U * 9);
  }
  EXPECT_EQ(ReceiveOp(clients.front(), "health")["viewers"], 20);
}

TEST(LiveViewTest, CutsOffAClientThatReadsNothingWhileOthersGoOn) {
  const std::string url = runtime::FreshMulticastUrl();
  Viewed viewed({"--lcm-url", url});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient lazy(viewed.port(), {.receive_bytes = 4096});
  WebClient eager(viewed.port());
  runtime::Bus bus(url);
  const std::vector<std::uint8_t> bytes(1300, 1);
  const TimePoint end = Clock::now() + kPatience;
  std::size_t sent = 0;
  std::size_t received = 0;
  while (viewed.process().Err().find("cut off: does not read") == std::string::npos) {
    ASSERT_LT(Clock::now(), end);
    for (int i = 0; i < 100; ++i) bus.Publish("FLOOD", bytes);
    sent += 100;
    while (received < sent && Clock::now() < end) {
      const WebFrame frame = eager.Receive(kPatience);
      if (KindOf(frame) == 1) received += MessagesOf(frame).size();
    }
  }
  // The server keeps 8 MiB for a client. The kernel may keep up to 8 MiB more.
  EXPECT_GT(sent * bytes.size(), 8U << 20);
  EXPECT_LT(sent * bytes.size(), 16U << 20);
  EXPECT_EQ(ReceiveOp(eager, "health")["cut_off"], 1);
  const std::uint16_t code = CloseCodeOf(lazy);
  EXPECT_TRUE(code == 1013 || code == 0) << code;  // 0: the closing frame is lost
  bus.Publish("AFTERWARDS", bytes);
  EXPECT_EQ(ReceiveOp(eager, "channel")["name"], "AFTERWARDS");
  EXPECT_EQ(viewed.End(), 0);
}

TEST(LiveViewTest, FollowsARunThatAnnouncesItself) {
  const ScratchFolder folder;
  const std::string meeting = runtime::FreshMulticastUrl();
  const std::vector<std::string> environment{"env", "LCM_DEFAULT_URL=" + meeting};
  const auto with = [&](std::vector<std::string> command) {
    command.insert(command.begin(), environment.begin(), environment.end());
    return command;
  };
  Background viewer(with({Program("fogline"), "view", "--no-browser", "--port", "0"}));
  ASSERT_TRUE(viewer.WaitForOut("\n")) << viewer.Err();
  const std::string address = viewer.Out();
  WebClient client(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
  Background run(with({Program("fogline"), "run", "scenario/paper.json", "--transport", "udpm",
                       "--pace", "2", "--quiet", "--log", folder.File("run.lcm")}));
  EXPECT_EQ(ReceiveOp(client, "run")["steps"], 500);
  json health;
  const TimePoint end = Clock::now() + kPatience;
  do {
    health = ReceiveOp(client, "health");
  } while (health["traffic"]["runs"].empty() && Clock::now() < end);
  ASSERT_EQ(health["traffic"]["announced"].size(), 1U);
  EXPECT_EQ(health["traffic"]["announced"][0]["followed"], true);
  run.Signal(SIGINT);
  run.Wait();
}

TEST(LiveViewTest, ShowsOnlySignedMessagesIfItHasAKey) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  const std::string key = folder.File("key");
  ASSERT_EQ(RunCommand({Program("fogline"), "keygen", key}).code, 0);
  Viewed viewed({"--lcm-url", url, "--key", key});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  runtime::Bus(url).Publish("TRUTH", std::vector<std::uint8_t>(100));
  std::vector<std::string> command = RunOn(url, folder.File("run.lcm"), 50, "10");
  command.insert(command.end(), {"--key", key});
  Background run(command);
  Got got;
  TakeUntil(50U * 9, client, got);
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_EQ(CompareWithLog(got, folder.File("run.lcm")), 50U * 9);
  EXPECT_EQ(ReceiveOp(client, "health")["unverified"], 1);
}

TEST(LiveViewTest, TakesItsKeyFromTheVariableAsARunDoes) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  const std::string key = folder.File("key");
  ASSERT_EQ(RunCommand({Program("fogline"), "keygen", key}).code, 0);
  Viewed viewed(Viewed::Started{{"env", "FOGLINE_KEY=" + key, Program("fogline"), "view",
                                 "--no-browser", "--port", "0", "--lcm-url", url}});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  runtime::Bus(url).Publish("TRUTH", std::vector<std::uint8_t>(100));
  const TimePoint end = Clock::now() + kPatience;
  while (ReceiveOp(client, "health")["unverified"] != 1) ASSERT_LT(Clock::now(), end);
}

TEST(LiveViewTest, GivesFoxglovesClientsMessagesAsJson) {
  const ScratchFolder folder;
  const std::string url = runtime::FreshMulticastUrl();
  Viewed viewed({"--lcm-url", url});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port(), {.protocol = "foxglove.sdk.v1"});
  EXPECT_EQ(ReceiveOp(client, "serverInfo")["op"], "serverInfo");
  const json advertised = ReceiveOp(client, "advertise");
  int truth = -1;
  for (const json& channel : advertised["channels"]) {
    if (channel["topic"] == "TRUTH") truth = channel["id"];
  }
  ASSERT_GE(truth, 0);
  client.Send(json{{"op", "subscribe"},
                   {"subscriptions", json::array({{{"id", 77}, {"channelId", truth}}})}}
                  .dump());
  Background run(RunOn(url, folder.File("run.lcm"), 20, "10"));
  std::set<std::int64_t> steps;
  while (steps.size() < 20) {
    const std::string frame = ReceiveKind(client, 1).bytes;
    std::string_view rest(frame);
    rest.remove_prefix(1);
    EXPECT_EQ(web::TakeLittleEndian<std::uint32_t>(rest), 77U);
    EXPECT_GT(web::TakeLittleEndian<std::uint64_t>(rest), 1'600'000'000'000'000'000U);
    steps.insert(json::parse(rest)["header"]["step"].get<std::int64_t>());
  }
  EXPECT_EQ(*steps.rbegin(), 19);
  EXPECT_EQ(run.Wait(), 0) << run.Err();
}

}  // namespace
}  // namespace fogline::test
