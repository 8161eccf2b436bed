// The wall clock of each step is in the log and in exports, but not in the digest.
#include <chrono>
#include <csignal>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/log/run_log.h"
#include "services/log/wall_clock.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

std::int64_t UnixMicros() {
  const auto time = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(time).count();
}

class WallClockTest : public testing::Test {
 protected:
  static Outcome Fogline(const Words& words) {
    Words command{Program("fogline")};
    command.insert(command.end(), words.begin(), words.end());
    return RunCommand(command);
  }
  std::string Digest(const Words& more) const {
    Words words{"run",   "scenario/paper.json", "--json", "--quiet", "--force", "--log", log_,
                "--set", "/steps=200"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome run = Fogline(words);
    EXPECT_EQ(run.code, 0) << run.err;
    return nlohmann::json::parse(run.out)["digest"];
  }
  std::vector<wall_clock_t> Clocks() const {
    log::RunLogReader reader(log_);
    while (reader.Next() != nullptr) {
    }
    std::vector<wall_clock_t> clocks;
    log::ForEachWallClock(
        log_, reader.run().run_id,
        [&](const wall_clock_t& clock, runtime::Bytes) { clocks.push_back(clock); });
    return clocks;
  }

  const ScratchFolder folder_;
  const std::string log_ = folder_.File("run.lcm");
};

TEST_F(WallClockTest, InLockstepIsInTheLogOnRequestAndNotInTheDigest) {
  const std::string digest = Digest({});
  EXPECT_TRUE(Clocks().empty());
  for (const char* transport : {"udpm", "memq"}) {
    SCOPED_TRACE(transport);
    const std::int64_t before = UnixMicros();
    EXPECT_EQ(Digest({"--wall-clock", "--transport", transport}), digest);
    const std::int64_t after = UnixMicros();
    const std::vector<wall_clock_t> clocks = Clocks();
    ASSERT_EQ(clocks.size(), 200U);
    std::int64_t earlier = before;
    for (std::size_t step = 0; step < clocks.size(); ++step) {
      EXPECT_EQ(clocks[step].header.step, static_cast<std::int64_t>(step));
      EXPECT_EQ(clocks[step].header.utime, static_cast<std::int64_t>(step) * 100'000);
      if (clocks[step].late) continue;
      EXPECT_GE(clocks[step].unix_us, earlier);
      earlier = clocks[step].unix_us;
    }
    EXPECT_LE(earlier, after);
    EXPECT_EQ(Fogline({"digest", log_}).code, 0);
    EXPECT_EQ(Fogline({"replay", log_, "--all"}).code, 0);
  }
}

TEST_F(WallClockTest, InLockstepIsThereAfterARunWasResumed) {
  const std::string digest = Digest({});
  std::filesystem::remove(log_);  // so that GrowsTo() sees the log of the next run
  // GIVEN a run that was interrupted
  Background run({Program("fogline"), "run", "scenario/paper.json", "--quiet", "--force", "--log",
                  log_, "--set", "/steps=200", "--pace", "2", "--wall-clock"});
  ASSERT_TRUE(GrowsTo(60'000, log_));
  run.Signal(SIGINT);
  ASSERT_EQ(run.Wait(), 130) << run.Err();
  // WHEN the run is resumed without the option
  const Outcome resumed = Fogline({"run", "--resume", log_, "--json", "--quiet"});
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(nlohmann::json::parse(resumed.out)["digest"], digest);
  // THEN all steps have their wall clock
  EXPECT_EQ(Clocks().size(), 200U);
}

TEST_F(WallClockTest, SurvivesTheDeathOfTheRecorderAndOfARoleThatAsksItForOldSteps) {
  const std::string digest = Digest({});
  std::filesystem::remove(log_);  // so that GrowsTo() sees the log of the next run
  Background run({Program("fogline"), "run", "scenario/paper.json", "--force", "--log", log_,
                  "--json", "--set", "/steps=200", "--pace", "20", "--wall-clock",
                  "--stall-timeout", "30"});
  ASSERT_TRUE(run.WaitForErr("processes: "));
  ASSERT_TRUE(GrowsTo(100'000, log_));
  kill(PidOf(run.Err(), "recorder"), SIGKILL);
  ASSERT_TRUE(GrowsTo(150'000, log_));
  kill(PidOf(run.Err(), "fusion"), SIGKILL);
  ASSERT_EQ(run.Wait(), 0) << run.Err();
  EXPECT_EQ(nlohmann::json::parse(run.Out())["digest"], digest);
  EXPECT_EQ(Clocks().size(), 200U);
}

TEST_F(WallClockTest, IsExportedAsATableOfItsOwn) {
  Digest({"--wall-clock"});
  const std::string out = folder_.File("csv");
  ASSERT_EQ(Fogline({"export", log_, "--out", out}).code, 0);
  std::istringstream rows(Content(out + "/WALL_CLOCK.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "header.run_id,header.step,header.utime,unix_us,monotonic_us,late");
  int count = 0;
  while (std::getline(rows, row)) ++count;
  EXPECT_EQ(count, 200);
  // AND an export of a log without wall clock removes the table of the older export
  Digest({});
  ASSERT_EQ(Fogline({"export", log_, "--out", out, "--force"}).code, 0);
  EXPECT_EQ(Content(out + "/WALL_CLOCK.csv"), "");
}

TEST_F(WallClockTest, IsRefusedForARunWithoutARecorder) {
  const Outcome run =
      Fogline({"run", "scenario/paper.json", "--transport", "direct", "--wall-clock"});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("error: --wall-clock: a run with --transport direct"));
}

class WallClockInRealtimeTest : public WallClockTest {};

TEST_F(WallClockInRealtimeTest, IsAlwaysInTheLogAndRunsAtTheSpeedOfTheRun) {
  Digest({"--realtime", "--speed", "5"});
  const std::vector<wall_clock_t> clocks = Clocks();
  ASSERT_GE(clocks.size(), 190U);
  const wall_clock_t& first = clocks.front();
  const wall_clock_t& last = clocks.back();
  const double simulated_s = static_cast<double>(last.header.utime - first.header.utime) / 1e6;
  for (const double wall_s : {static_cast<double>(last.unix_us - first.unix_us) / 1e6,
                              static_cast<double>(last.monotonic_us - first.monotonic_us) / 1e6}) {
    EXPECT_NEAR(wall_s, simulated_s / 5, 1.0);  // a busy machine may delay the first or last step
  }
}

}  // namespace
}  // namespace fogline::test
