// Runs that start roles on other machines. A script in place of ssh enters a simulated machine, so
// no server is needed. tests/campaign/ssh_hosts_test.cc repeats some of these tests with OpenSSH,
// and has further tests.
#include "tests/integration/hosts/hosts_fixture.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace fogline::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// Two machines, and a command in place of ssh that starts commands on the second machine.
class EnteredHostsTest : public HostsTest {
 protected:
  void SetUp() override {
    HostsTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    lab_.emplace(2);
    std::ofstream script(folder_.File("enter"));
    // The last argument of the script is the command that ssh would execute on the other machine.
    // The script sets SSH_CONNECTION, as sshd does.
    script << "for command; do :; done\nexport SSH_CONNECTION='10.76.67.1 1 10.76.67.2 22'\nexec";
    for (const std::string& word : (*lab_)[1].On({"sh", "-c"})) script << " '" << word << "'";
    script << " \"$command\"\n";
  }
  const Lab& lab() const { return *lab_; }
  std::string Enter() const { return "sh '" + folder_.File("enter") + "'"; }
  /// The error text of a run that calls the command `ssh` in place of ssh. The run must fail.
  std::string Failure(const std::string& ssh, const std::vector<std::string>& places) {
    const Outcome outcome = RunCommand(RunFrom(lab()[0], ssh, places));
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    return outcome.err;
  }

  ScratchFolder folder_;

 private:
  std::optional<Lab> lab_;
};

TEST_F(EnteredHostsTest, HaveTheDigestOfDirect) { ExpectTheDigestOfDirect(lab(), Enter()); }

TEST_F(EnteredHostsTest, StartAKilledRoleThereAgain) {
  ExpectAKilledRoleIsStartedThereAgain(lab(), Enter());
}

TEST_F(EnteredHostsTest, EndSoonAfterCtrlC) {
  // The limit is long enough for a busy machine. A machine that is not busy needs less than 5 s.
  // Processes that a run leaves behind end by themselves, but only 15 s after the stall timeout of
  // 30 s. So the limit of 30 s also finds such processes.
  ExpectCtrlCEndsEverything(lab(), Enter(), std::chrono::seconds(30));
}

TEST_F(EnteredHostsTest, LeaveNothingBehindAfterTheRunnersDeath) {
  ExpectNothingIsLeftOfARunnerThatWasKilled(lab(), Enter());
}

TEST_F(EnteredHostsTest, NeedAnAddressForTheRelayIfTheyAreReachedOverIpv6) {
  const std::string ssh = folder_.File("ipv6");
  std::ofstream(ssh) << "for command; do :; done\n"
                        "export SSH_CONNECTION='fd00::1 1 fd00::2 22'\n"
                        "exec sh -c \"$command\"\n";
  std::vector<std::string> places = OnLab2({"fusion"});
  places.emplace_back("--relay");
  EXPECT_THAT(
      Failure("sh '" + ssh + "'", places),
      HasSubstr("lab2 reaches this machine over IPv6 (fd00::1), but a relay needs IPv4; give "
                "an IPv4 address: --relay-at ADDRESS"));
}

TEST_F(EnteredHostsTest, UseTheRelayWhereThereIsNoMulticast) {
  ExpectTheRelayCarriesARunWithoutMulticast(lab(), Enter());
}

TEST_F(EnteredHostsTest, SayThatNoMessageArrivesWithoutMulticast) {
  BlockUdpBetween(lab());
  EXPECT_THAT(Failure(Enter(), OnLab2({"fusion"})),
              HasSubstr("it runs on lab2, but none of its messages arrive; if the network carries "
                        "no multicast: --relay"));
}

TEST_F(EnteredHostsTest, EndTheRunWhenTheConnectionEnds) {
  Background run(RunFrom(lab()[0], Enter(), OnLab2({"fusion", "acc"}), {"--pace", "1"}));
  ASSERT_TRUE(IsUnderWay()) << run.Err();
  for (const pid_t child : ChildrenOf(run.pid())) {
    if (Content("/proc/" + std::to_string(child) + "/comm") == "fogline\n")
      SignalOne(child, SIGKILL);
  }
  EXPECT_EQ(run.Wait(), 3);
  EXPECT_THAT(run.Err(), HasSubstr(" on lab2) lost its connection (fogline host was killed by "
                                   "signal 9 (Killed)) at step "));
  EXPECT_THAT(LeftOn(lab()[1]), IsEmpty());
}

TEST_F(EnteredHostsTest, PrintTheLastLinesOfARoleWithTheNameOfItsMachine) {
  // GIVEN a script in place of the ACC's program on the other machine. The script ends by itself
  std::ofstream(folder_.File("fogline-acc")) << "#!/bin/sh\necho 'no sensor' >&2\nexit 3\n";
  std::filesystem::permissions(folder_.File("fogline-acc"), std::filesystem::perms::owner_all);
  std::filesystem::copy(Program("fogline"), folder_.File("fogline"));
  EXPECT_THAT(Failure(Enter(), {"--on", "acc=lab2:" + folder_.path().string()}),
              AllOf(HasSubstr(" on lab2) exited with code 3 before step 0\n"),
                    HasSubstr("\n  lab2: acc: no sensor\n")));
}

TEST_F(EnteredHostsTest, NameAMachineWithoutTheProgram) {
  EXPECT_THAT(Failure(Enter(), {"--on", "acc=lab2:/none"}),
              StartsWith("fogline run: error: lab2: there is no /none/fogline\n"));
}

TEST_F(EnteredHostsTest, SayThatThereIsNoSsh) {
  EXPECT_THAT(
      Failure("/none/ssh -p 2222", OnLab2({"acc"})),
      StartsWith("fogline run: error: lab2: the command '/none/ssh -p 2222' cannot be run on "
                 "this machine\n"));
}

TEST_F(EnteredHostsTest, NameAMachineWithoutARoute) {
  lab()[1].Do("ip route del 239.0.0.0/8");
  EXPECT_THAT(Failure(Enter(), OnLab2({"acc"})),
              StartsWith("fogline run: error: lab2: no route to 239.255.76.67: "));
}

TEST_F(EnteredHostsTest, NameAMachineWithAnotherVersion) {
  const std::string other = MakeOtherVersion(folder_.File("fogline"));
  const std::string error = Failure(Enter(), {"--on", "acc=lab2:" + folder_.path().string()});
  EXPECT_THAT(error, StartsWith("fogline run: error: lab2: fogline there is " + other + ", here "));
}

TEST_F(EnteredHostsTest, GiveTheKeyToTheMachineWithoutACommandLineOrAFile) {
  const std::string key = folder_.File("lab.key");
  ASSERT_EQ(RunCommand({Program("fogline"), "keygen", key}).code, 0);
  Background run(RunFrom(lab()[0], Enter(), OnLab2({"fusion"}), {"--key", key, "--pace", "5"}));
  ASSERT_TRUE(IsUnderWay()) << run.Err();
  const pid_t fusion = PidOf(run.Err(), "fusion");
  const std::string arguments = Content("/proc/" + std::to_string(fusion) + "/cmdline");
  EXPECT_THAT(arguments, HasSubstr("--key"));
  EXPECT_EQ(arguments.find("lab.key"), std::string::npos);
  EXPECT_EQ(arguments.find(Content(key).substr(0, 64)), std::string::npos);
  EXPECT_EQ(ResultOf(run)["digest"], Undisturbed());
}

TEST_F(EnteredHostsTest, AreDescribedOnceInAFile) {
  std::ofstream(folder_.File("lab.json"))
      << R"({"version": 1, "url": "udpm://239.255.76.67:7711?ttl=1", "ssh": ")" << Enter()
      << R"(", "hosts": [{"name": "lab2", "programs": ")" << ProgramDirectory().string()
      << R"(", "roles": ["fusion", "acc"]}]})";
  const auto result = Result(RunCommand(lab()[0].On(Run({"--lab", folder_.File("lab.json")}))));
  EXPECT_EQ(result["digest"], Undisturbed());
  EXPECT_EQ(result["transport"], "udpm://239.255.76.67:7711?ttl=1");
}

TEST_F(EnteredHostsTest, AreResumedByTheCommandThatTheRunPrints) {
  Background run(RunFrom(lab()[0], Enter(), OnLab2({"fusion"}), {"--pace", "10"}));
  ASSERT_TRUE(IsUnderWay()) << run.Err();
  run.Signal(SIGINT);
  EXPECT_EQ(run.Wait(), 130);
  EXPECT_THAT(run.Err(), HasSubstr(" --on 'fusion=lab2:"));
  std::vector<std::string> again{Program("fogline"), "run",   "--resume", Log(),
                                 "--json",           "--ssh", Enter()};
  for (const std::string& word : OnLab2({"fusion"})) again.push_back(word);
  EXPECT_EQ(Result(RunCommand(lab()[0].On(again)))["digest"], Undisturbed());
}

TEST_F(EnteredHostsTest, DriveInRealtimeToo) {
  Background run(RunFrom(lab()[0], Enter(), OnLab2({"acc"}),
                         {"--realtime", "--speed", "5", "--set", "/steps=50"}));
  EXPECT_EQ(ResultOf(run)["steps"], 50) << run.Err();
}

TEST_F(EnteredHostsTest, MakeTheRunsOfATable) {
  const auto table = [](const std::vector<std::string>& more) {
    std::vector<std::string> command{Program("fogline"), "table",        "scenario/paper.json",
                                     "--json",           "--thresholds", "0.5"};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  };
  std::vector<std::string> places = OnLab2({"fusion"});
  places.insert(places.end(), {"--ssh", Enter()});
  const auto result = Result(RunCommand(lab()[0].On(table(places))));
  EXPECT_EQ(result["transport"], "udpm");
  EXPECT_EQ(result["rows"], Result(RunCommand(table({})))["rows"]);
  EXPECT_THAT(LeftOn(lab()[1]), IsEmpty());
}

TEST(HostVerbTest, SaysItsVersionAndEndsWithItsInput) {
  const Outcome host = RunCommand({Program("fogline"), "host"});  // stdin is /dev/null
  EXPECT_EQ(host.code, 0) << host.err;
  const auto hello = nlohmann::json::parse(host.out, nullptr, false);
  EXPECT_EQ(hello["fogline_host"].get<std::string>() + "\n",
            RunCommand({Program("fogline"), "--version"}).out);
}

TEST(HostVerbTest, RefusesWhatIsNoOrder) {
  for (const std::string order : {"hello", "[]", "{}", R"({"start": "acc"})", R"({"kill": "me"})",
                                  R"({"start": "pilot", "arguments": []})"}) {
    const Outcome host =
        RunCommand({"sh", "-c", "echo \"$1\" | exec \"$0\" host", Program("fogline"), order});
    EXPECT_EQ(host.code, 2) << order;
    EXPECT_THAT(host.err, StartsWith("fogline host: error: stdin: ")) << order;
  }
}

}  // namespace
}  // namespace fogline::test
