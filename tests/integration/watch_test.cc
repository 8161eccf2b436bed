// `fogline top` on live traffic, and on a log that lcm-logplayer plays. `fogline doctor` on
// machines with and without a network.
#include <fcntl.h>
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include "services/runtime/bus.h"
#include "services/runtime/multicast_route.h"
#include "tests/support/command.h"
#include "tests/support/machine.h"
#include "tests/support/network.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::HasSubstr;

// Programs start and messages arrive within this time, even when every processor is busy.
constexpr seconds kPatience(30);

const json& Find(const json& array, const std::string& key, const std::string& value) {
  static const json kNone;
  for (const json& element : array) {
    if (element[key] == value) return element;
  }
  ADD_FAILURE() << "no " << key << " " << value << " in " << array.dump(1);
  return kNone;
}

/// `fogline top --json`, which prints a document for each interval until the test ends.
class Top {
 public:
  explicit Top(Bus& bus)
      : bus_(bus),
        process_({Program("fogline"), "top", "--json", "--interval", "0.2", "--for", "60",
                  "--lcm-url", bus.url()}) {}

  pid_t pid() const { return process_.pid(); }

  /// Waits until top shows everything that was sent so far.
  [[nodiscard]] bool CatchUp(const std::string& mark) {
    const TimePoint end = Clock::now() + kPatience;
    while (process_.Out().find("\"" + mark + "\"") == std::string::npos) {
      if (Clock::now() > end) return false;
      bus_.Publish(mark, std::vector<std::uint8_t>{0});
      bus_.Wait(milliseconds(10));
    }
    return true;
  }
  /// The last document that is complete.
  json Last() const {
    std::string out = process_.Out();
    out.erase(out.rfind('\n'));
    const std::size_t begin = out.rfind('\n');
    return json::parse(begin == std::string::npos ? out : out.substr(begin + 1));
  }

 private:
  Bus& bus_;
  Background process_;
};

TEST(TopTest, ShowsEveryRoleAndChannelOfARunAtItsPace) {
  // GIVEN a run in real speed, 10 steps a second, that is under way
  const ScratchFolder folder;
  Bus bus(FreshMulticastUrl());
  std::int64_t step = -1;
  bus.Subscribe(ChannelOf<truth_t>().name,
                [&step](Bytes bytes) { step = ReadInt64(bytes, kStepOffset); });
  const Background run({Program("fogline"), "run", "scenario/paper.json", "--pace", "1", "--quiet",
                        "--lcm-url", bus.url(), "--log", folder.File("run.lcm")});
  const TimePoint end = Clock::now() + kPatience;
  while (step < 5 && Clock::now() < end) bus.Wait(milliseconds(100));
  ASSERT_GE(step, 5) << run.Err();
  // WHEN top watches it for two seconds
  const Outcome top = RunCommand(
      {Program("fogline"), "top", "--once", "--json", "--interval", "2", "--lcm-url", bus.url()});
  ASSERT_EQ(top.code, 0) << top.err;
  // THEN top shows the run, and every channel that has a message in every step has 10 per second
  const json document = json::parse(top.out);
  ASSERT_EQ(document["runs"].size(), 1U) << top.out;
  const json& seen = document["runs"][0];
  EXPECT_GT(seen["step"], 5);
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace != Pace::kStep) continue;
    SCOPED_TRACE(channel.name);
    const json& row = Find(seen["channels"], "channel", std::string(channel.name));
    // The tolerance covers a message more or less at either end, and a busy machine.
    EXPECT_NEAR(row["rate_hz"].get<double>(), 10, 1.5);
    EXPECT_EQ(row["lost"], 0);
    EXPECT_EQ(row["undecodable"], 0);
    EXPECT_GT(row["bandwidth_bytes_per_s"], 10.0 * kHeaderEnd * 0.8);
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
  Bus bus(url);
  Top top(bus);
  ASSERT_TRUE(top.CatchUp("BEFORE"));
  std::vector<std::uint8_t> lidar;
  Encode(lidar_t{}, lidar);
  std::vector<std::uint8_t> cut;
  Encode(radar_t{}, cut);
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
  ExpectUndecodableCounted(FreshMulticastUrl());
}

TEST(TopTest, LooksAtARelayToo) {
  Background relay({Program("fogline-relay"), "--listen", "127.0.0.1:0"});
  ASSERT_TRUE(relay.WaitForOut("\n")) << relay.Err();
  ExpectUndecodableCounted(relay.Out().substr(0, relay.Out().find('\n')));
}

TEST(TopTest, ShowsALogThatLogplayerPlays) {
  constexpr int kSteps = 100;
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  const Outcome run = RunCommand({Program("fogline"), "run", "scenario/paper.json", "--set",
                                  "/steps=" + std::to_string(kSteps), "--transport", "memq",
                                  "--quiet", "--log", log});
  ASSERT_EQ(run.code, 0) << run.err;
  Bus bus(FreshMulticastUrl());
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
      RunCommand({"env", "LCM_DEFAULT_URL=" + FreshMulticastUrl(), "sh", "-c",
                  "printf q | script -qec '" + Program("fogline") + " top' /dev/null"},
                 kPatience);
  EXPECT_EQ(top.code, 0);
  EXPECT_THAT(top.out, HasSubstr("\033[?1049h"));
  EXPECT_THAT(top.out, HasSubstr("0 runs"));
  EXPECT_THAT(top.out, testing::EndsWith("\033[?1049l"));
}

TEST(WatchTest, RefusesUrlsThatNameNoNetwork) {
  for (const char* verb : {"top", "spy", "doctor"}) {
    const Outcome memory = RunCommand({Program("fogline"), verb, "--lcm-url", "memq://"});
    EXPECT_EQ(memory.code, 2);
    EXPECT_THAT(memory.err, HasSubstr("the memory of one process"));
    EXPECT_EQ(memory.out, "");
    const Outcome file = RunCommand({Program("fogline"), verb, "--lcm-url", "file://run.lcm"});
    EXPECT_EQ(file.code, 2);
    EXPECT_THAT(file.err, HasSubstr("not an LCM network"));
  }
}

/// The levels of all findings of one check.
std::multiset<std::string> Levels(const json& document, const std::string& check) {
  std::multiset<std::string> levels;
  for (const json& finding : document["findings"]) {
    if (finding["check"] == check) levels.insert(finding["level"].get<std::string>());
  }
  return levels;
}

TEST(DoctorTest, ExaminesThisMachineWithoutFindingAProblemThatTheOtherTestsWouldHave) {
  const Outcome doctor = RunCommand({Program("fogline"), "doctor", "--json"});
  const json document = json::parse(doctor.out);
  EXPECT_EQ(doctor.code, document["problems"] == 0 ? 0 : 1);
  for (const char* check : {"multicast_route", "multicast_loopback", "receive_buffer", "other_runs",
                            "processes", "programs", "lcm", "lcm_tools", "java", "clock", "wakeup",
                            "time_sync", "cpus", "governor", "disk"}) {
    EXPECT_FALSE(Levels(document, check).empty()) << check;
  }
  for (const char* check : {"multicast_route", "multicast_loopback", "socket_filter", "programs"}) {
    EXPECT_EQ(Levels(document, check), std::multiset<std::string>{"ok"}) << doctor.out;
  }
  for (const json& finding : document["findings"]) {
    EXPECT_NE(finding["what"], "");
    EXPECT_TRUE(finding["level"] == "ok" || finding["remedy"] != "") << finding;
  }
}

TEST(DoctorTest, NamesTheRoleThatRunsByItselfAndLeavesItAlone) {
  const std::string url = FreshMulticastUrl();
  const Background role({Program("fogline-radar"), "--lcm-url", url, "--run-id", "4711"});
  const std::string name = "fogline-radar (pid " + std::to_string(role.pid()) + ")";
  const TimePoint end = Clock::now() + kPatience;
  Outcome doctor{};
  do {  // until the new process executes the wanted program
    doctor = RunCommand({Program("fogline"), "doctor"});
  } while (doctor.out.find(name) == std::string::npos && Clock::now() < end);
  EXPECT_THAT(doctor.out, HasSubstr("warning  " + name + " on " + url +
                                    " is left of a run whose runner is gone  -> kill " +
                                    std::to_string(role.pid()) + "\n"));
  EXPECT_TRUE(IsAlive(role.pid()));
}

TEST(DoctorTest, SaysWhatToWriteInPlaceOfAnAddressThatIsNoGroup) {
  const Outcome doctor =
      RunCommand({Program("fogline"), "doctor", "--lcm-url", "udpm://10.0.0.1:7700"});
  EXPECT_EQ(doctor.code, 1);
  EXPECT_EQ(doctor.err, "");
  EXPECT_THAT(doctor.out,
              HasSubstr("problem  10.0.0.1 is no multicast group (224.0.0.0 to 239.255.255.255)  "
                        "-> write udpm://239.255.76.67:7700, the same on every machine; or "
                        "tcpq://10.0.0.1:7700 with `fogline-relay --listen 10.0.0.1:7700` on that "
                        "machine\n"));
}

TEST(DoctorTest, ExaminesARelay) {
  Background relay({Program("fogline-relay"), "--listen", "127.0.0.1:0"});
  ASSERT_TRUE(relay.WaitForOut("\n")) << relay.Err();
  const std::string url = relay.Out().substr(0, relay.Out().find('\n'));
  const Outcome there = RunCommand({Program("fogline"), "doctor", "--lcm-url", url});
  EXPECT_THAT(there.out, HasSubstr("ok       the relay " + url + " answers\n"));
  EXPECT_THAT(there.out, HasSubstr("nobody is heard on " + url));
  relay.Signal(SIGTERM);
  EXPECT_EQ(relay.Wait(), 0);
  const Outcome gone = RunCommand({Program("fogline"), "doctor", "--lcm-url", url});
  EXPECT_EQ(gone.code, 1);
  EXPECT_THAT(gone.out, HasSubstr("problem  nobody listens on "));
}

TEST(DoctorTest, NamesProgramsThatAreMissingOrOfAnotherBuild) {
  const ScratchFolder folder;
  std::filesystem::copy_file(Program("fogline"), folder.File("fogline"));
  const std::string radar = folder.File("fogline-radar");
  std::ofstream(radar) << "#!/bin/sh\necho 0.0.1, message types 0123456789abcdef\n";
  std::filesystem::permissions(radar, std::filesystem::perms::owner_all);
  const Outcome doctor =
      RunCommand({folder.File("fogline"), "doctor", "--lcm-url", "tcpq://127.0.0.1:1"});
  EXPECT_EQ(doctor.code, 1);
  EXPECT_THAT(doctor.out,
              HasSubstr("problem  " + radar +
                        " is \"0.0.1, message types 0123456789abcdef\", but fogline is"));
  EXPECT_THAT(doctor.out, HasSubstr("problem  " + folder.File("fogline-world") +
                                    " cannot be run  -> ninja -C build fogline_programs\n"));
}

TEST(TopTest, EndsWhenItsTerminalIsGone) {
  // GIVEN top on a terminal that does not control it, so no signal tells top of the terminal's end
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(grantpt(terminal) + unlockpt(terminal), 0);
  Background top({"sh", "-c", "exec <\"$0\" >\"$0\"; exec \"$@\"", ptsname(terminal),
                  Program("fogline"), "top", "--interval", "0.2", "--lcm-url",
                  FreshMulticastUrl()});
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
  Bus bus(FreshMulticastUrl());
  Top top(bus);
  ASSERT_TRUE(top.CatchUp("BEGUN"));
  const std::int64_t before = MemoryOf(top.pid());
  // WHEN each message comes on a channel of its own (LCM keeps about 200 bytes for each name)
  const std::unique_ptr<lcm_t, decltype(&lcm_destroy)> stranger(lcm_create(bus.url().c_str()),
                                                                &lcm_destroy);
  constexpr int kBursts = 15;
  constexpr int kNames = 4000;
  for (int burst = 0; burst < kBursts; ++burst) {
    for (int i = 0; i < kNames; ++i) {
      const std::string name =
          "INVENTED_" + std::string(40, 'X') + std::to_string(kNames * burst + i);
      lcm_publish(stranger.get(), name.c_str(), "", 1);
    }
    ASSERT_TRUE(top.CatchUp("BURST" + std::to_string(burst)));
  }
  // THEN top reports how many channels it has forgotten, and LCM has forgotten them, too
  EXPECT_GT(top.Last()["forgotten"], kBursts * kNames / 2);
  EXPECT_LE(top.Last()["others"].size(), 64U);
  EXPECT_LT(MemoryOf(top.pid()) - before, 6'000'000);
}

/// Machines without a network, or with one of their own.
class DoctorOnMachineTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = WhyNoMachines(); !why.empty()) {
      return MachineLacks("root, network namespaces or nftables: " + why);
    }
  }
  static Outcome Doctor(const Machine& machine, const std::string& url) {
    return RunCommand(machine.On({Program("fogline"), "doctor", "--lcm-url", url, "--json"}));
  }
};

constexpr const char* kHere = "udpm://239.255.76.67:7700?ttl=0";
constexpr const char* kEverywhere = "udpm://239.255.76.67:7700?ttl=1";

TEST_F(DoctorOnMachineTest, FindsTheMissingRouteAndItsRemedyHelps) {
  const Machine island("island");
  // Without a route LCM's own programs do not work, nor does a run on several machines.
  const Outcome here = Doctor(island, kHere);
  EXPECT_EQ(here.code, 0) << here.err;
  const json own = json::parse(here.out);
  EXPECT_EQ(Find(own["findings"], "check", "multicast_route")["level"], "warning");
  EXPECT_THAT(Find(own["findings"], "check", "multicast_route")["remedy"].get<std::string>(),
              HasSubstr(std::string(kLoopbackRoute)));
  EXPECT_EQ(Levels(own, "multicast_loopback"), std::multiset<std::string>{"ok"});
  const Outcome before = Doctor(island, kEverywhere);
  EXPECT_EQ(before.code, 1) << before.err;
  const json document = json::parse(before.out);
  EXPECT_EQ(document["problems"], 1);
  const json& route = Find(document["findings"], "check", "multicast_route");
  EXPECT_EQ(route["level"], "problem");
  EXPECT_EQ(route["what"], "no route to 239.255.76.67: Network is unreachable");
  EXPECT_THAT(route["remedy"].get<std::string>(), HasSubstr(std::string(kLoopbackRoute)));
  // WHEN the remedy is applied
  island.Do(std::string(kLoopbackRoute));
  const Outcome after = Doctor(island, kHere);
  EXPECT_EQ(after.code, 0) << after.out << after.err;
  const json mended = json::parse(after.out);
  EXPECT_EQ(Find(mended["findings"], "check", "multicast_route")["what"],
            "239.255.76.67 goes over loopback and stays on this machine (ttl=0)");
  EXPECT_EQ(Levels(mended, "multicast_loopback"), std::multiset<std::string>{"ok"});
  // THEN it suffices for this machine, but not for others
  const Outcome wider = Doctor(island, kEverywhere);
  EXPECT_EQ(wider.code, 1);
  EXPECT_THAT(wider.out, HasSubstr("no other machine hears it"));
}

TEST_F(DoctorOnMachineTest, HearsTheRunOfAnotherMachine) {
  const ScratchFolder folder;
  const Lab lab(2);
  Background run(lab[0].On({Program("fogline"), "run", "scenario/paper.json", "--pace", "1",
                            "--lcm-url", kEverywhere, "--log", folder.File("run.lcm")}));
  ASSERT_TRUE(run.WaitForErr("processes: ")) << run.Err();
  const Outcome doctor = Doctor(lab[1], kEverywhere);
  EXPECT_EQ(doctor.code, 0) << doctor.out << doctor.err;
  const json document = json::parse(doctor.out);
  const std::string heard = Find(document["findings"], "check", "other_runs")["what"];
  EXPECT_THAT(heard, HasSubstr("run " + run.Err().substr(4, run.Err().find(" on ") - 4)));
  // doctor sees the processes of this computer in every network namespace.
  EXPECT_THAT(doctor.out, HasSubstr("fogline (pid " + std::to_string(run.pid()) +
                                    ") has a run with 9 processes on " + kEverywhere));
  for (const RoleInfo& info : kRoles) {
    const pid_t pid = PidOf(run.Err(), std::string(info.name));
    EXPECT_THAT(heard, HasSubstr(std::string(info.name) + " " + std::to_string(pid) + "@lab1"));
  }
}

}  // namespace
}  // namespace fogline::test
