// `fogline doctor` on machines with and without a network.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "common/clock.h"
#include "services/graph.h"
#include "services/runtime/transport/multicast_route.h"
#include "services/runtime/transport/udpm/fresh_url.h"
#include "tests/integration/verbs/find_in_json.h"
#include "tests/support/command.h"
#include "tests/support/machine.h"
#include "tests/support/network.h"

namespace fogline::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Levels of all findings of one check.
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
  const std::string url = runtime::FreshMulticastUrl();
  const Background role({Program("fogline-radar"), "--lcm-url", url, "--run-id", "4711"});
  const std::string name = "fogline-radar (pid " + std::to_string(role.pid()) + ")";
  const TimePoint end = Clock::now() + kPatience;
  Outcome doctor{};
  do {  // until exec() has replaced the child by the program
    doctor = RunCommand({Program("fogline"), "doctor"});
  } while (doctor.out.find(name) == std::string::npos && Clock::now() < end);
  EXPECT_THAT(doctor.out, HasSubstr("warning  " + name + " on " + url +
                                    " takes part in no other run than 4711, whose runner has not "
                                    "started it  -> if this run is over: kill " +
                                    std::to_string(role.pid()) + "\n"));
  EXPECT_TRUE(IsAlive(role.pid()));
}

TEST(DoctorTest, KnowsThatAnExperimentRunsRoles) {
  // GIVEN a process with the name fogline-experiment that has started a role. The role ends with
  // this process
  const ScratchFolder folder;
  const std::string experiment = folder.File("fogline-experiment");
  std::filesystem::copy_file("/bin/sh", experiment);
  const std::string url = runtime::FreshMulticastUrl();
  const Background runner({experiment, "-c",
                           "setpriv --pdeathsig KILL " + Program("fogline-radar") + " --lcm-url '" +
                               url + "' --run-id 4711 & wait"});
  const TimePoint end = Clock::now() + kPatience;
  Outcome doctor{};
  do {  // until exec() has replaced the shell's child by the role
    doctor = RunCommand({Program("fogline"), "doctor"});
  } while (doctor.out.find(url) == std::string::npos && Clock::now() < end);
  EXPECT_THAT(doctor.out,
              HasSubstr("ok       fogline-experiment (pid " + std::to_string(runner.pid()) +
                        ") has a run with 1 processes on " + url + "\n"));
}

TEST(DoctorTest, NamesTheNetworkOfARunOverARelay) {
  const ScratchFolder folder;
  Background run({Program("fogline"), "run", "scenario/paper.json", "--transport", "tcpq", "--pace",
                  "1", "--log", folder.File("run.lcm")});
  ASSERT_TRUE(run.WaitForErr("processes: ")) << run.Err();
  const Outcome doctor = RunCommand({Program("fogline"), "doctor"});
  EXPECT_THAT(doctor.out, testing::ContainsRegex("fogline \\(pid " + std::to_string(run.pid()) +
                                                 "\\) has a run with [0-9]+ processes on "
                                                 "tcpq://127.0.0.1:[0-9]+\n"));
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
  EXPECT_THAT(there.out, HasSubstr("no traffic on " + url));
  relay.Signal(SIGTERM);
  EXPECT_EQ(relay.Wait(), 0);
  const Outcome gone = RunCommand({Program("fogline"), "doctor", "--lcm-url", url});
  EXPECT_EQ(gone.code, 1);
  EXPECT_THAT(gone.out, HasSubstr("problem  no process listens on "));
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
  EXPECT_THAT(doctor.out,
              HasSubstr("problem  " + folder.File("fogline-world") +
                        " cannot be run  -> install all programs of one version of Fogline\n"));
}

TEST(DoctorTest, NamesTheCommandThatBuildsAMissingProgram) {
  const ScratchFolder build;
  std::ofstream(build.File("build.ninja")) << "";
  std::filesystem::create_directory(build.File("bin"));
  std::filesystem::copy_file(Program("fogline"), build.File("bin/fogline"));
  const Outcome doctor =
      RunCommand({build.File("bin/fogline"), "doctor", "--lcm-url", "tcpq://127.0.0.1:1"});
  EXPECT_THAT(doctor.out, HasSubstr(" cannot be run  -> ninja -C "));
  EXPECT_THAT(doctor.out, HasSubstr(build.path().filename().string() + " fogline_programs\n"));
}

/// Machines without a network, or with a network of their own.
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
  // Without a route, only LCM's own programs and runs on several machines fail.
  const Outcome here = Doctor(island, kHere);
  EXPECT_EQ(here.code, 0) << here.err;
  const json own = json::parse(here.out);
  EXPECT_EQ(Find(own["findings"], "check", "multicast_route")["level"], "warning");
  EXPECT_THAT(Find(own["findings"], "check", "multicast_route")["remedy"].get<std::string>(),
              HasSubstr(std::string(runtime::kLoopbackRoute)));
  EXPECT_EQ(Levels(own, "multicast_loopback"), std::multiset<std::string>{"ok"});
  const Outcome before = Doctor(island, kEverywhere);
  EXPECT_EQ(before.code, 1) << before.err;
  const json document = json::parse(before.out);
  EXPECT_EQ(document["problems"], 1);
  const json& route = Find(document["findings"], "check", "multicast_route");
  EXPECT_EQ(route["level"], "problem");
  EXPECT_EQ(route["what"], "no route to 239.255.76.67: Network is unreachable");
  EXPECT_THAT(route["remedy"].get<std::string>(), HasSubstr(std::string(runtime::kLoopbackRoute)));
  // WHEN the remedy is applied
  island.Do(std::string(runtime::kLoopbackRoute));
  const Outcome after = Doctor(island, kHere);
  EXPECT_EQ(after.code, 0) << after.out << after.err;
  const json mended = json::parse(after.out);
  EXPECT_EQ(Find(mended["findings"], "check", "multicast_route")["what"],
            "239.255.76.67 goes over loopback and stays on this machine (ttl=0)");
  EXPECT_EQ(Levels(mended, "multicast_loopback"), std::multiset<std::string>{"ok"});
  // THEN the route over loopback is enough for runs on this machine, but not for runs with other
  // machines
  const Outcome wider = Doctor(island, kEverywhere);
  EXPECT_EQ(wider.code, 1);
  EXPECT_THAT(wider.out, HasSubstr("no other machine hears it"));
}

TEST_F(DoctorOnMachineTest, HearsTheRunOfAnotherMachine) {
  const ScratchFolder folder;
  const Lab lab(2);
  Background run(
      lab[0].On({Program("fogline"), "run", "scenario/paper.json", "--pace", "1", "--set",
                 "/steps=10000", "--lcm-url", kEverywhere, "--log", folder.File("run.lcm")}));
  ASSERT_TRUE(run.WaitForErr("processes: ")) << run.Err();
  const TimePoint end = Clock::now() + kPatience;
  Outcome doctor{};
  std::string heard;
  do {  // on a busy machine a role may send nothing in the 1 s for which doctor listens
    doctor = Doctor(lab[1], kEverywhere);
    ASSERT_LE(doctor.code, 1) << doctor.out << doctor.err;
    heard = Find(json::parse(doctor.out)["findings"], "check", "other_runs")["what"];
  } while ((doctor.code != 0 || std::ranges::count(heard, '@') < std::ssize(kRoles)) &&
           Clock::now() < end);
  EXPECT_EQ(doctor.code, 0) << doctor.out << doctor.err;
  EXPECT_THAT(heard, HasSubstr("run " + run.Err().substr(4, run.Err().find(" on ") - 4)));
  // doctor names the processes of this machine on all networks.
  EXPECT_THAT(doctor.out,
              HasSubstr("fogline (pid " + std::to_string(run.pid()) + ") has a run with " +
                        std::to_string(kRoles.size()) + " processes on " + kEverywhere));
  for (const RoleInfo& info : kRoles) {
    const pid_t pid = PidOf(run.Err(), std::string(info.name));
    EXPECT_THAT(heard, HasSubstr(std::string(info.name) + " " + std::to_string(pid) + "@lab1"));
  }
}

}  // namespace
}  // namespace fogline::test
