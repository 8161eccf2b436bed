// `fogline top` on live traffic and on a log that lcm-logplayer plays.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <sys/stat.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include "services/runtime/transport/bus.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/verbs/find_in_json.h"
#include "tests/integration/verbs/top_process.h"
#include "tests/support/command.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::HasSubstr;

// 10 messages per second. The tolerance allows one message more or less at each end of two seconds.
constexpr double kPace_hz = 10;
constexpr double kPaceTolerance_hz = 1.5;

/// Whether top's document shows kPace_hz on every channel with a message in each step.
bool ShowsPace(const std::string& shown) {
  if (shown.empty()) return false;
  const json document = json::parse(shown);
  if (document["runs"].size() != 1) return false;
  return std::ranges::all_of(kChannels, [&](const ChannelInfo& channel) {
    if (channel.pace != Pace::kStep) return true;
    const json& row = Find(document["runs"][0]["channels"], "channel", std::string(channel.name));
    return std::abs(row["rate_hz"].get<double>() - kPace_hz) <= kPaceTolerance_hz;
  });
}

TEST(TopTest, ShowsEveryRoleAndChannelOfARunAtItsPace) {
  // GIVEN a run at real speed, 10 steps a second, that is under way and lasts for the whole test
  const ScratchFolder folder;
  runtime::Bus bus(runtime::FreshMulticastUrl());
  std::int64_t step = -1;
  TimePoint heard{};
  int uneven = 0;  // steps that came too late or too early
  bus.Subscribe(ChannelOf<truth_t>().name, [&](runtime::Bytes bytes) {
    step = runtime::ReadInt64(bytes, runtime::kStepOffset);
    const TimePoint now = Clock::now();
    uneven += now - heard < milliseconds(50) || now - heard > milliseconds(150) ? 1 : 0;
    heard = now;
  });
  const Background run({Program("fogline"), "run", "scenario/paper.json", "--pace", "1", "--quiet",
                        "--set", "/steps=10000", "--lcm-url", bus.url(), "--log",
                        folder.File("run.lcm")});
  const TimePoint end = Clock::now() + kPatience;
  while (step < 5 && Clock::now() < end) bus.Wait(milliseconds(100));
  ASSERT_GE(step, 5) << run.Err();
  // WHEN top watches the run for two seconds. top counts a message when it handles the message. So
  // if the machine holds up the run or top in this time, top shows other rates, and the test tries
  // again.
  std::string shown;
  const TimePoint last_try = Clock::now() + kPatience;
  while (!ShowsPace(shown) && Clock::now() < last_try) {
    uneven = 0;
    Background top(
        {Program("fogline"), "top", "--once", "--json", "--interval", "2", "--lcm-url", bus.url()});
    const TimePoint limit = Clock::now() + kPatience;
    while (IsAlive(top.pid()) && Clock::now() < limit) bus.Wait(milliseconds(10));
    ASSERT_EQ(top.Wait(), 0) << top.Err();
    if (uneven == 0) shown = top.Out();
  }
  ASSERT_NE(shown, "") << "the machine disturbed every try";
  // THEN top shows the run, and 10 messages per second on every channel with a message in every
  // step
  const json document = json::parse(shown);
  ASSERT_EQ(document["runs"].size(), 1U) << shown;
  const json& seen = document["runs"][0];
  EXPECT_GT(seen["step"], 5);
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace != Pace::kStep) continue;
    SCOPED_TRACE(channel.name);
    const json& row = Find(seen["channels"], "channel", std::string(channel.name));
    EXPECT_NEAR(row["rate_hz"].get<double>(), kPace_hz, kPaceTolerance_hz);
    EXPECT_EQ(row["lost"], 0);
    EXPECT_EQ(row["undecodable"], 0);
    EXPECT_GT(row["bandwidth_bytes_per_s"], 10.0 * runtime::kHeaderEnd * 0.8);
  }
  // AND every role runs
  ASSERT_EQ(seen["roles"].size(), kRoles.size());
  for (const RoleInfo& info : kRoles) {
    SCOPED_TRACE(info.name);
    const json& role = Find(seen["roles"], "role", std::string(info.name));
    EXPECT_EQ(role["state"], "RUNNING");
    EXPECT_TRUE(IsAlive(role["pid"]));
    EXPECT_GT(role["rss_bytes"], 1'000'000);
    EXPECT_TRUE(role["cpu_percent"].is_number());
    EXPECT_EQ(role["refused"], json::object());
  }
}

/// Expects that top counts messages on RADAR that are not a radar_t.
void ExpectUndecodableCounted(const std::string& url) {
  runtime::Bus bus(url);
  Top top(bus);
  ASSERT_TRUE(top.CatchUp("BEFORE"));
  std::vector<std::uint8_t> lidar;
  runtime::Encode(lidar_t{}, lidar);
  std::vector<std::uint8_t> cut;
  runtime::Encode(radar_t{}, cut);
  cut.pop_back();
  for (int i = 0; i < 3; ++i) bus.Publish("RADAR", std::vector<std::uint8_t>{1, 2, 3});
  for (int i = 0; i < 2; ++i) bus.Publish("RADAR", lidar);
  bus.Publish("RADAR", cut);
  ASSERT_TRUE(top.CatchUp("AFTER"));
  const json document = top.Last();
  const json& radar = Find(document["others"], "channel", "RADAR");
  EXPECT_EQ(radar["messages"], 6);
  EXPECT_EQ(radar["undecodable"], 6);
  EXPECT_EQ(radar["undecodable_as"], (json{{"unknown", 3}, {"lidar_t", 2}, {"radar_t", 1}}));
  EXPECT_TRUE(document["runs"].empty());
}

TEST(TopTest, CountsWhatItCannotDecodeByTheTypeThatItSeemsToBe) {
  ExpectUndecodableCounted(runtime::FreshMulticastUrl());
}

TEST(TopTest, LooksAtARelayToo) {
  Background relay({Program("fogline-relay"), "--listen", "127.0.0.1:0"});
  ASSERT_TRUE(relay.WaitForOut("\n")) << relay.Err();
  ExpectUndecodableCounted(relay.Out().substr(0, relay.Out().find('\n')));
}

TEST(TopTest, ShowsALogThatLogplayerPlays) {
  // The run has so few steps that the kernel's buffer holds all their messages, even if top gets no
  // processor time.
  constexpr int kSteps = 12;
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--set",
                                  "/steps=" + std::to_string(kSteps), "--transport", "memq",
                                  "--quiet", "--log", log});
  ASSERT_EQ(run.code, 0) << run.err;
  runtime::Bus bus(runtime::FreshMulticastUrl());
  Top top(bus);
  ASSERT_TRUE(top.CatchUp("BEFORE"));
  const Outcome player = RunCommand({"lcm-logplayer", "--speed=10", "--lcm-url=" + bus.url(), log});
  ASSERT_EQ(player.code, 0) << player.err;
  ASSERT_TRUE(top.CatchUp("AFTER"));
  const json document = top.Last();
  ASSERT_EQ(document["runs"].size(), 1U);
  const json& seen = document["runs"][0];
  EXPECT_EQ(seen["step"], kSteps - 1);
  EXPECT_TRUE(seen["roles"].empty());  // no role runs, so there is no STATUS
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace != Pace::kStep) continue;
    SCOPED_TRACE(channel.name);
    const json& row = Find(seen["channels"], "channel", std::string(channel.name));
    EXPECT_EQ(row["messages"], kSteps);
    EXPECT_EQ(row["lost"].get<int>() + row["missing"].get<int>(), 0);
    EXPECT_EQ(row["undecodable"], 0);
  }
}

TEST(TopTest, DrawsOnATerminalAndGivesItBackWhenQIsPressed) {
  const Outcome top =
      RunCommand({"env", "LCM_DEFAULT_URL=" + runtime::FreshMulticastUrl(), "sh", "-c",
                  "printf q | script -qec '" + Program("fogline") + " top' /dev/null"},
                 kPatience);
  EXPECT_EQ(top.code, 0);
  EXPECT_THAT(top.out, HasSubstr("\033[?1049h"));
  EXPECT_THAT(top.out, HasSubstr("0 runs"));
  EXPECT_THAT(top.out, testing::EndsWith("\033[?1049l"));
}

TEST(TopTest, IsInterruptedByCtrlCAndGivesTheTerminalBack) {
  const ScratchFolder folder;
  const std::string keys = folder.File("keys");
  ASSERT_EQ(mkfifo(keys.c_str(), 0600), 0);
  const int fd = open(keys.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(fd, 0);
  Background top({"env", "LCM_DEFAULT_URL=" + runtime::FreshMulticastUrl(), "sh", "-c",
                  "exec script -qec '" + Program("fogline") + " top' /dev/null < \"$0\"", keys});
  ASSERT_TRUE(top.WaitForOut("0 runs", kPatience)) << top.Out();
  ASSERT_EQ(write(fd, "\003", 1), 1);
  EXPECT_EQ(top.Wait(kPatience), 130);
  EXPECT_THAT(top.Out(), testing::EndsWith("\033[?1049l"));
  close(fd);
}

TEST(WatchTest, RefusesUrlsThatNameNoNetwork) {
  for (const char* verb : {"top", "spy", "doctor"}) {
    const Outcome memory = RunCommand({Program("fogline"), verb, "--lcm-url", "memq://"});
    EXPECT_EQ(memory.code, 2);
    EXPECT_THAT(memory.err, HasSubstr("other processes cannot look into the memory of a process"));
    EXPECT_EQ(memory.out, "");
    const Outcome file = RunCommand({Program("fogline"), verb, "--lcm-url", "file://run.lcm"});
    EXPECT_EQ(file.code, 2);
    EXPECT_THAT(file.err, HasSubstr("error: --lcm-url file://run.lcm: no LCM URL such as"));
  }
}

TEST(TopTest, EndsWhenItsTerminalIsGone) {
  // GIVEN top on a terminal that is not its controlling terminal. So no signal tells top that the
  // terminal was closed
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(grantpt(terminal) + unlockpt(terminal), 0);
  Background top({"sh", "-c", "exec <\"$0\" >\"$0\"; exec \"$@\"", ptsname(terminal),
                  Program("fogline"), "top", "--interval", "0.2", "--lcm-url",
                  runtime::FreshMulticastUrl()});
  std::array<char, 64> buffer{};
  ASSERT_GT(read(terminal, buffer.data(), buffer.size()), 0) << "it draws";
  // WHEN the terminal's window is closed
  close(terminal);
  EXPECT_EQ(top.Wait(kPatience), 3);
  EXPECT_EQ(top.Err(), "fogline top: error: the terminal is gone\n");
}

/// Resident memory of a process in bytes.
std::int64_t MemoryOf(pid_t pid) {
  std::ifstream statm("/proc/" + std::to_string(pid) + "/statm");
  std::int64_t pages = 0;
  statm >> pages >> pages;
  return pages * sysconf(_SC_PAGESIZE);
}

TEST(TopTest, RemembersOnlySoManyChannelsHoweverManyNamesAreInvented) {
  runtime::Bus bus(runtime::FreshMulticastUrl());
  Top top(bus);
  ASSERT_TRUE(top.CatchUp("BEGUN"));
  const std::int64_t before = MemoryOf(top.pid());
  // WHEN each message comes on a channel of its own (LCM keeps about 200 bytes for each name)
  const std::unique_ptr<lcm_t, decltype(&lcm_destroy)> foreign_sender(lcm_create(bus.url().c_str()),
                                                                      &lcm_destroy);
  // From each burst, top receives at least the messages that fit into a small socket buffer, about
  // 250 names. If top has a processor to itself, it receives all messages. So the test sends bursts
  // until top has forgotten kEnough names.
  constexpr int kNames = 4000;
  constexpr int kEnough = 50'000;  // 10 MB of names
  int invented = 0;
  const TimePoint end = Clock::now() + kPatience;
  for (int burst = 0; top.Last()["forgotten"] < kEnough; ++burst) {
    ASSERT_LT(Clock::now(), end) << top.Last()["forgotten"] << " of " << invented;
    for (int i = 0; i < kNames; ++i) {
      const std::string name = "INVENTED_" + std::string(40, 'X') + std::to_string(invented++);
      lcm_publish(foreign_sender.get(), name.c_str(), "", 1);
    }
    ASSERT_TRUE(top.CatchUp("BURST" + std::to_string(burst)));
  }
  // THEN top keeps few of the names, and LCM has forgotten the other names, too
  EXPECT_LE(top.Last()["others"].size(), 64U);
  EXPECT_LT(MemoryOf(top.pid()) - before, 6'000'000);
}

}  // namespace
}  // namespace fogline::test
