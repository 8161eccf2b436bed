// `fogline replay --live`: recorded messages take the place of some roles, and all other roles run.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/process/priority.h"
#include "services/log/event_log.h"
#include "services/log/remains.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/command.h"
#include "tests/support/machine.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

class LiveReplayTest : public testing::Test {
 protected:
  LiveReplayTest() {
    const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                                    "direct", "--json", "--log", log_, "--set", "/steps=250"});
    EXPECT_EQ(run.code, 0) << run.err;
    digest_ = nlohmann::json::parse(run.out)["digest"];
  }

  Outcome Replay(const std::string& log, const Words& more) const {
    Words command{Program("fogline"), "replay", log, "--live", "--log", live_, "--force", "--json"};
    command.insert(command.end(), more.begin(), more.end());
    return RunCommand(command);
  }
  nlohmann::json Live(const Words& more) const {
    const Outcome outcome = Replay(log_, more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
  const std::string live_ = folder_.File("live.lcm");
  std::string digest_;
};

TEST_F(LiveReplayTest, OfUnchangedRolesIsTheRecordedRun) {
  const nlohmann::json live = Live({});
  EXPECT_EQ(live["channels"], (nlohmann::json{"RADAR", "LIDAR"}));
  EXPECT_EQ(live["digest"], digest_);
  EXPECT_EQ(live["track"]["compared_steps"], 250);
  EXPECT_EQ(live["track"]["distance_m"]["largest"], 0);
  EXPECT_EQ(live["track"]["distance_m"]["rms"], 0);
}

TEST_F(LiveReplayTest, SignsItsMessagesIfTheVariableNamesAKey) {
  const std::string key = folder_.File("key");
  ASSERT_EQ(RunCommand({Program("fogline"), "keygen", key}).code, 0);
  const Outcome outcome = RunCommand({"env", "FOGLINE_KEY=" + key, Program("fogline"), "replay",
                                      log_, "--live", "--log", live_, "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["digest"], digest_);
  EXPECT_EQ(RunCommand({Program("fogline"), "digest", live_, "--key", key}).code, 0);
}

TEST_F(LiveReplayTest, TellsHowMuchTheTrackOfAnotherFusionDiffers) {
  // GIVEN the recorded sensors and a fusion that trusts the radar less
  const nlohmann::json live =
      Live({"--set", "/fusion/radar_range_std_m=0.5", "--transport", "tcpq"});
  const nlohmann::json& distance = live["track"]["distance_m"];
  EXPECT_GT(distance["largest"], 0.01);
  EXPECT_GT(distance["rms"], 0);
  EXPECT_LT(distance["rms"], distance["largest"]);
  // THEN the new log has the recorded messages, and its TRACK differs by the reported distance
  const auto track_of = [](const std::string& log, std::int64_t step) {
    log::EventLogReader reader(log);
    track_t track{};
    while (const auto event = reader.Next()) {
      if (event->channel == "TRACK" && runtime::Decode(event->data, track) &&
          track.header.step == step) {
        return track.state[0];
      }
    }
    return 0.0;
  };
  const std::int64_t step = distance["step"];
  EXPECT_EQ(std::abs(track_of(log_, step) - track_of(live_, step)), distance["largest"]);
  const Outcome diff = RunCommand({Program("fogline"), "diff", log_, live_});
  EXPECT_THAT(diff.out, HasSubstr(": TRACK "));  // RADAR and LIDAR come before TRACK, and are equal
}

TEST_F(LiveReplayTest, OfAnyOtherChannelReplacesItsRole) {
  const nlohmann::json live = Live({"--channels", "DRIVER_COMMAND"});
  EXPECT_EQ(live["digest"], digest_);
}

TEST_F(LiveReplayTest, OfALogOfSeveralRunsTakesTheChosenOne) {
  const std::string before = folder_.File("before.lcm");
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--transport",
                                  "direct", "--quiet", "--log", before, "--seed", "2"});
  ASSERT_EQ(run.code, 0) << run.err;
  const std::string both = folder_.File("both.lcm");
  std::ofstream(both, std::ios::binary) << Content(before) << Content(log_);
  const Outcome outcome = Replay(both, {"--run", std::to_string(log::ReadFront(log_).run_id)});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json live = nlohmann::json::parse(outcome.out, nullptr, false);
  EXPECT_EQ(live["digest"], digest_);
  EXPECT_EQ(live["track"]["compared_steps"], 250);
  EXPECT_EQ(live["track"]["distance_m"]["largest"], 0);
}

TEST_F(LiveReplayTest, OfALogWithAGapIsRefusedInLockstep) {
  const std::string gap = folder_.File("gap.lcm");
  log::EventLogReader reader(log_);
  {
    log::EventLogWriter writer(gap);
    while (const auto event = reader.Next()) {
      const std::int64_t step = runtime::ReadInt64(event->data, runtime::kStepOffset);
      if (event->channel == "RADAR" && step == 100) continue;
      writer.Write(event->channel, event->utime, event->data);
    }
  }
  const Outcome outcome = Replay(gap, {});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("gap.lcm: error: step 100 lacks RADAR: a run in lockstep"));
  // With `--channels LIDAR` the replay needs only the messages of LIDAR, and the log has them all.
  EXPECT_EQ(Replay(gap, {"--channels", "LIDAR"}).code, 1);
}

TEST_F(LiveReplayTest, ReplacesTheRecordedLogNotEvenIfForced) {
  const std::string before = Content(log_);
  const std::string link = folder_.File("link.lcm");
  std::filesystem::create_symlink(log_, link);
  for (const std::string& file : {log_, link}) {
    const Outcome outcome = RunCommand(
        {Program("fogline"), "replay", log_, "--live", "--log", file, "--force", "--quiet"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, file +
                               ": error: --log: this is the recorded log; the new run needs "
                               "another file\n");
  }
  EXPECT_EQ(Content(log_), before);
}

TEST_F(LiveReplayTest, SaysWhatIsWrongWithItsArguments) {
  const auto error = [&](const Words& more) {
    const Outcome outcome = Replay(log_, more);
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_THAT(error({"--channels", "RADRA"}),
              HasSubstr("error: --channels RADRA: not one of \"RADAR\", \"LIDAR\""));
  EXPECT_THAT(error({"--channels", "TRUTH"}), HasSubstr("--channels TRUTH: not one of"));
  EXPECT_THAT(
      error({"--transport", "memq"}),
      HasSubstr("error: --transport memq: all roles are in one process; a live replay needs a "
                "process for each role"));
  EXPECT_THAT(error({"--set", "/step_s=0.05"}), HasSubstr("--set /step_s"));
  EXPECT_THAT(error({"--all"}), HasSubstr("--live makes a run"));
}

class LiveReplayInRealtimeTest : public LiveReplayTest {};

TEST_F(LiveReplayInRealtimeTest, DrivesTheSystemByTheWallClock) {
  const nlohmann::json live = Live({"--realtime", "--speed", "5"});
  EXPECT_EQ(live["steps"], 250);
  EXPECT_EQ(live["realtime"]["speed"], 5);
  // If a message is late, the fusion computes a step differently. But the fusions of the recorded
  // run and of the replay get the same sensor values, so their tracks stay near each other.
  EXPECT_GT(live["track"]["compared_steps"], 200);
  EXPECT_LT(live["track"]["distance_m"]["rms"], 0.1);
}

TEST_F(LiveReplayInRealtimeTest, RunsTheThreadsOfItsRolesBeforeOthersAndSaysSo) {
  bool granted = false;
  std::thread([&granted] { granted = RunThreadBeforeOthers(1); }).join();
  if (!granted) return MachineLacks("the right to real-time priority");
  Background program({Program("fogline"), "replay", log_, "--live", "--realtime", "--speed", "2",
                      "--log", live_, "--json", "--quiet"});
  // THEN four threads have real-time priority: the threads of radar and LiDAR, and a thread for the
  // backlog of each of their two buses
  constexpr int kThreads = 4;
  int threads = 0;
  while (threads < kThreads && IsAlive(program.pid())) {
    threads = ThreadsBeforeOthers(program.pid());
    std::this_thread::sleep_for(kLookEvery);
  }
  EXPECT_EQ(threads, kThreads);
  ASSERT_EQ(program.Wait(), 0) << program.Err();
  const auto live = nlohmann::json::parse(program.Out());
  EXPECT_THAT(live["realtime"]["priority"]["refused"], ::testing::IsEmpty());
}

}  // namespace
}  // namespace fogline::test
