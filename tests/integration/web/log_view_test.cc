// `fogline view LOG`: its clients get the messages of the log.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "services/log/event_log.h"
#include "services/log/remains.h"
#include "services/log/run_log.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/web/viewed.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Makes the log of a run in one process.
void MakeLog(const std::string& log, int steps) {
  const Outcome run =
      RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport", "direct",
                  "--set", "/steps=" + std::to_string(steps), "--log", log, "--quiet"});
  ASSERT_EQ(run.code, 0) << run.err;
}

TEST(LogViewTest, ShowsTheChosenRunOfALogOfTwo) {
  const ScratchFolder folder;
  MakeLog(folder.File("first.lcm"), 20);
  MakeLog(folder.File("second.lcm"), 30);
  const std::string both = folder.File("both.lcm");
  std::ofstream(both, std::ios::binary)
      << Content(folder.File("first.lcm")) << Content(folder.File("second.lcm"));
  const std::string second = std::to_string(log::ReadFront(folder.File("second.lcm")).run_id);
  Viewed viewed({both, "--run", second});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  EXPECT_EQ(ReceiveOp(client, "run")["run_id"], second);
  EXPECT_EQ(ReceiveOp(client, "log")["last_step"], 29);
  const Outcome unknown =
      RunCommand({Program("fogline"), "view", both, "--no-browser", "--run", "5"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("the log has no run 5; it has "));
}

TEST(LogViewTest, DescribesTheRunOfTheLog) {
  const ScratchFolder folder;
  const std::string log = folder.File("paper.lcm");
  MakeLog(log, 320);
  Viewed viewed({log});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  EXPECT_EQ(client.protocol(), "fogline.view.v1");
  const json hello = ReceiveOp(client, "hello");
  EXPECT_EQ(hello["mode"], "log");
  EXPECT_EQ(hello["url"], nullptr);
  ASSERT_EQ(hello["channels"].size(), kNumChannels);
  for (std::size_t i = 0; i < kNumChannels; ++i) {
    EXPECT_EQ(hello["channels"][i]["id"], i);
    EXPECT_EQ(hello["channels"][i]["name"], std::string(kChannels[i].name));
  }
  EXPECT_TRUE(hello["types"].contains("truth_t"));
  EXPECT_TRUE(hello["fingerprints"].contains("truth_t"));
  const json run = ReceiveOp(client, "run");
  EXPECT_EQ(run["steps"], 320);
  EXPECT_EQ(run["step_s"], 0.1);
  EXPECT_EQ(run["realtime"], false);
  EXPECT_EQ(run["scenario"]["steps"], 320);
  EXPECT_THAT(run["title"].get<std::string>(), HasSubstr("fog"));
  EXPECT_GT(std::stoll(run["run_id"].get<std::string>()), 0);
  const json described = ReceiveOp(client, "log");
  EXPECT_EQ(described["file"], "paper.lcm");
  EXPECT_EQ(described["first_step"], 0);
  EXPECT_EQ(described["last_step"], 319);
  EXPECT_EQ(described["complete"], true);
  EXPECT_EQ(described["note"], "");
  // The transfers equal those of the verb `events`.
  std::vector<std::int64_t> transfers;
  for (const json& event : described["events"]) {
    if (event["kind"] == "transfer") transfers.push_back(event["step"]);
  }
  std::vector<std::int64_t> expected;
  const Outcome events = RunCommand({Program("fogline"), "events", "--json", log});
  const json logs = json::parse(events.out);
  for (const json& event : logs[0]["events"]) {
    if (event["transfer"] == true) expected.push_back(event["step"]);
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(transfers, expected);
  EXPECT_EQ(viewed.End(), 0);
}

TEST(LogViewTest, GivesEachMessageOfEachStepAsItStandsInTheLog) {
  const ScratchFolder folder;
  const std::string log = folder.File("paper.lcm");
  MakeLog(log, 150);
  Viewed viewed({log});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  std::map<std::pair<std::int64_t, std::size_t>, std::string> got;
  for (int from = 0; from < 150; from += 64) {
    client.Send(json{{"op", "steps"}, {"id", from}, {"from", from}, {"to", from + 63}}.dump());
    for (WebMessage& message : MessagesOf(ReceiveKind(client, 2))) {
      EXPECT_TRUE(got.emplace(std::pair(message.step, message.channel), message.bytes).second);
    }
  }
  log::RunLogReader reader(log);
  std::int64_t step = 0;
  std::size_t messages = 0;
  for (; const log::StepMessages* expected = reader.Next(); ++step) {
    for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
      const runtime::Bytes bytes = (*expected)[channel];
      if (bytes.empty()) continue;
      ++messages;
      EXPECT_TRUE(std::ranges::equal(BytesOf(got[std::pair(step, channel)]), bytes))
          << "step " << step << ", " << kChannels[channel].name;
    }
  }
  EXPECT_EQ(step, 150);
  EXPECT_EQ(got.size(), messages);
}

/// The times and values of a frame of kind 3, the answer to a request for a series.
/// @param whole whether the frame must say that it has every value
std::pair<std::vector<double>, std::vector<double>> SeriesOf(const WebFrame& frame,
                                                             std::uint32_t id, bool whole) {
  std::string_view rest = frame.bytes;
  rest.remove_prefix(1);
  EXPECT_EQ(web::TakeLittleEndian<std::uint32_t>(rest), id);
  EXPECT_EQ(web::TakeLittleEndian<std::uint8_t>(rest), whole ? 1 : 0);
  std::vector<double> times(web::TakeLittleEndian<std::uint32_t>(rest));
  std::vector<double> values(times.size());
  EXPECT_EQ(rest.size(), 2 * sizeof(double) * times.size());
  for (double& time : times) time = web::TakeLittleEndian<double>(rest);
  for (double& value : values) value = web::TakeLittleEndian<double>(rest);
  return {times, values};
}

TEST(LogViewTest, GivesAFieldOverTimeAndLosesNoPeak) {
  const ScratchFolder folder;
  const std::string log = folder.File("paper.lcm");
  MakeLog(log, 400);
  std::vector<double> gaps;
  log::RunLogReader reader(log);
  truth_t truth{};
  while (const log::StepMessages* messages = reader.Next()) {
    ASSERT_TRUE(runtime::Decode((*messages)[IndexOf<truth_t>()], truth));
    gaps.push_back(truth.host_gap_m);
  }
  Viewed viewed({log});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  const auto ask = [&](std::uint32_t id, const std::string& field, int points) {
    client.Send(json{
        {"op", "series"},
        {"id", id},
        {"channel", "TRUTH"},
        {"field", field},
        {"from", 0},
        {"to", 1'000'000},
        {"points",
         points}}.dump());
  };
  ask(1, "host_gap_m", 200);
  const auto [times, values] = SeriesOf(ReceiveKind(client, 3), 1, true);
  EXPECT_EQ(values, gaps);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(times[i], 0.1 * static_cast<double>(i), 1e-9);
  }
  ask(2, "host_gap_m", 20);
  const auto [few_times, few] = SeriesOf(ReceiveKind(client, 3), 2, false);
  EXPECT_LE(few.size(), 40U);
  EXPECT_EQ(std::ranges::min(few), std::ranges::min(gaps));
  EXPECT_EQ(std::ranges::max(few), std::ranges::max(gaps));
  EXPECT_TRUE(std::ranges::is_sorted(few_times));
  ask(3, "host_gap", 20);
  const json error = ReceiveOp(client, "error");
  EXPECT_EQ(error["id"], 3);
  EXPECT_THAT(error["message"].get<std::string>(), HasSubstr("host_gap_m"));
}

TEST(LogViewInRealtimeTest, GivesAFieldOfTheStatusOfOneRole) {
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--realtime",
                                  "--set", "/step_s=0.01", "--set", "/steps=200", "--lcm-url",
                                  runtime::FreshMulticastUrl(), "--log", log, "--quiet"});
  ASSERT_EQ(run.code, 0) << run.err;
  std::vector<double> steps;
  log::EventLogReader reader(log);
  status_t status{};
  while (const auto event = reader.Next()) {
    if (event->channel == ChannelOf<status_t>().name && runtime::Decode(event->data, status) &&
        status.role == "fusion" && status.header.step >= 0) {
      steps.push_back(static_cast<double>(status.header.step));
    }
  }
  ASSERT_FALSE(steps.empty());
  Viewed viewed({log});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  const auto ask = [&](std::uint32_t id, std::int64_t points, bool changes) {
    client.Send(json{
        {"op", "series"},
        {"id", id},
        {"channel", "STATUS/fusion"},
        {"field", "header.step"},
        {"from", 0},
        {"to", 199},
        {"points", points},
        {"changes",
         changes}}.dump());
    return ReceiveKind(client, 3);
  };
  EXPECT_EQ(SeriesOf(ask(1, std::ssize(steps), false), 1, true).second, steps);
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  EXPECT_EQ(SeriesOf(ask(2, std::ssize(steps), true), 2, false).second, steps);
}

TEST(LogViewTest, AnswersBadRequestsAndGoesOn) {
  const ScratchFolder folder;
  const std::string log = folder.File("paper.lcm");
  MakeLog(log, 20);
  Viewed viewed({log});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  for (const char* bad : {"", "{", "[]", R"({"op":"steps","id":1,"from":0,"to":512})",
                          R"({"op":"history","id":1})", R"({"op":"run","id":1})",
                          R"({"op":"series","id":1,"channel":"NONE","field":"phase",)"
                          R"("from":0,"to":1,"points":1})",
                          R"({"op":"series","id":1,"channel":"RUN/world","field":"phase",)"
                          R"("from":0,"to":1,"points":1})"}) {
    client.Send(bad);
    EXPECT_NE(ReceiveOp(client, "error")["message"], "") << bad;
  }
  client.Send(std::string(100, '\xff'), true);
  EXPECT_EQ(ReceiveOp(client, "error")["id"], nullptr);
  EXPECT_TRUE(
      viewed.process().WaitForErr("sends a wrong frame (9 so far): requests are text frames"));
  // If the log does not have the requested steps, the answer has no messages for them.
  client.Send(R"({"op":"steps","id":9,"from":15,"to":500})");
  EXPECT_EQ(MessagesOf(ReceiveKind(client, 2)).back().step, 19);
  client.Send(R"({"op":"steps","id":9,"from":100,"to":500})");
  EXPECT_TRUE(MessagesOf(ReceiveKind(client, 2)).empty());
}

TEST(LogViewTest, ShowsALogThatIsCutOffWithItsNote) {
  const ScratchFolder folder;
  const std::string log = folder.File("paper.lcm");
  MakeLog(log, 100);
  std::filesystem::resize_file(log, std::filesystem::file_size(log) / 2);
  Viewed viewed({log});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  EXPECT_THAT(viewed.process().Err(), HasSubstr("ends after step"));
  WebClient client(viewed.port());
  const json described = ReceiveOp(client, "log");
  EXPECT_EQ(described["complete"], false);
  EXPECT_THAT(described["note"].get<std::string>(), HasSubstr("ends after step"));
  EXPECT_GT(described["last_step"], 10);
  EXPECT_LT(described["last_step"], 90);
}

TEST(LogViewTest, NamesALogThatCannotBeShown) {
  const ScratchFolder folder;
  const auto view = [&](const std::string& file) {
    return RunCommand({Program("fogline"), "view", "--no-browser", "--port", "0", file});
  };
  const Outcome missing = view(folder.File("missing.lcm"));
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("missing.lcm: error: cannot read the log"));
  const Outcome other = view("README.md");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("not an LCM event log"));
  EXPECT_EQ(other.out, "");
  MakeLog(folder.File("paper.lcm"), 20);
  const Outcome beyond = RunCommand({Program("fogline"), "view", "--no-browser", "--port", "0",
                                     folder.File("paper.lcm"), "--open-at", "20"});
  EXPECT_EQ(beyond.code, 2);
  EXPECT_THAT(beyond.err, HasSubstr("--open-at 20: the last step of "));
}

/// The largest resident memory of a process so far, in bytes.
std::int64_t PeakMemory(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stoll(line.substr(6)) * 1024;
  }
  return -1;
}

TEST(LogViewTest, OpensAMillionMessagesIn3sAnd300MB) {
  const ScratchFolder folder;
  const std::string log = folder.File("long.lcm");
  constexpr int kSteps = 111'200;  // with nine messages each
  MakeLog(log, kSteps);
  Viewed viewed({log});
  ASSERT_NE(viewed.port(), 0) << viewed.process().Err();
  WebClient client(viewed.port());
  EXPECT_EQ(ReceiveOp(client, "log")["last_step"], kSteps - 1);
  // The limit is for processor time, because this time does not include other processes of a busy
  // machine.
  EXPECT_LT(ProcessorTime_s(viewed.process().pid()), 3.0);
  // The client asks for curves of the whole log, and for steps in all parts of the log.
  for (const char* field : {"host_gap_m", "follower_gap_m[0]"}) {
    client.Send(json{
        {"op", "series"},
        {"id", 1},
        {"channel", "TRUTH"},
        {"field", field},
        {"from", 0},
        {"to", kSteps},
        {"points",
         1000}}.dump());
    EXPECT_LE(ReceiveKind(client, 3).bytes.size(), 10 + 2000 * 2 * sizeof(double));
  }
  for (int from = 0; from < kSteps; from += kSteps / 20) {
    client.Send(json{{"op", "steps"}, {"id", 1}, {"from", from}, {"to", from + 500}}.dump());
    EXPECT_GE(MessagesOf(ReceiveKind(client, 2)).size(), 1U);
  }
  const std::int64_t peak = PeakMemory(viewed.process().pid());
  EXPECT_GT(peak, 0);
  EXPECT_LT(peak, 300'000'000);
}

}  // namespace
}  // namespace fogline::test
