// Runs that start roles on other machines by OpenSSH.
#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "services/graph.h"
#include "tests/campaign/ssh_lab.h"
#include "tests/integration/hosts/hosts_fixture.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class SshHostsTest : public HostsTest {
 protected:
  void SetUp() override {
    HostsTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    if (access(SshLab::kServer, X_OK) != 0) return MachineLacks("openssh-server");
  }
  /// The error text of a run with the role acc on another machine. The run must fail.
  std::string Failure(const SshLab& lab, const std::string& host,
                      const std::vector<std::string>& more = {}) {
    const Outcome outcome = RunCommand(RunFrom(lab[0], lab.ssh(), {"--on", On("acc", host)}, more));
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    return outcome.err;
  }
};

TEST_F(SshHostsTest, FourMachinesRunThePaperByOneCommandWithTheDigestOfDirect) {
  const SshLab lab(4);
  const std::vector<std::pair<std::string, std::string>> four_machines{
      {"radar", "lab2"},      {"lidar", "lab2"},  {"fusion", "lab3"},  {"acc", "lab3"},
      {"arbitrator", "lab3"}, {"driver", "lab4"}, {"follower", "lab4"}};
  std::vector<std::string> places;
  for (const auto& [role, host] : four_machines) {
    places.insert(places.end(), {"--on", On(role, host)});
  }
  Background run(RunFrom(lab[0], lab.ssh(), places, {"--pace", "50"}));
  ASSERT_TRUE(IsUnderWay()) << run.Err();
  EXPECT_THAT(FoglineOn(lab[2]),
              testing::ElementsAre("fogline", "fogline-acc", "fogline-arbitra", "fogline-fusion"));
  const auto result = ResultOf(run);
  EXPECT_EQ(result["digest"], Undisturbed());
  EXPECT_EQ(result["steps"], 500);
  EXPECT_TRUE(result["restarts"].empty()) << result["restarts"];
  for (const Machine& machine : lab.lab().machines()) EXPECT_THAT(LeftOn(machine), IsEmpty());
}

TEST_F(SshHostsTest, EveryRoleButTheRecorderMayRunOnAnotherMachine) {
  const SshLab lab(2);
  std::vector<std::string> roles;
  for (const RoleInfo& info : kRoles) {
    if (info.role != Role::kRecorder) roles.emplace_back(info.name);
  }
  const auto result = Result(RunCommand(RunFrom(lab[0], lab.ssh(), OnLab2(roles))));
  EXPECT_EQ(result["digest"], Undisturbed());
}

TEST_F(SshHostsTest, StartAKilledRoleThereAgain) {
  const SshLab lab(2);
  ExpectAKilledRoleIsStartedThereAgain(lab.lab(), lab.ssh());
}

TEST_F(SshHostsTest, KillAHangingRoleThereAndStartItAgain) {
  const SshLab lab(2);
  Background run(RunFrom(lab[0], lab.ssh(), OnLab2({"fusion"}), {"--pace", "20"}));
  ASSERT_TRUE(IsUnderWay()) << run.Err();
  SignalOne(PidOf(run.Err(), "fusion"), SIGSTOP);
  const auto result = ResultOf(run);
  EXPECT_EQ(result["digest"], Undisturbed());
  ASSERT_EQ(result["restarts"].size(), 1U) << run.Err();
  EXPECT_THAT(run.Err(), HasSubstr(" on lab2) was silent for "));
}

TEST_F(SshHostsTest, WaitForACableThatIsCutFor10s) {
  const SshLab lab(2);
  Background run(RunFrom(lab[0], lab.ssh(), OnLab2({"fusion", "acc"}), {"--pace", "20"}));
  ASSERT_TRUE(IsUnderWay()) << run.Err();
  lab.lab().Unplug(1);
  std::this_thread::sleep_for(std::chrono::seconds(10));  // the machine is unplugged for 10 s
  lab.lab().Plug(1);
  const auto result = ResultOf(run);
  EXPECT_EQ(result["digest"], Undisturbed());
  EXPECT_TRUE(result["restarts"].empty()) << result["restarts"];
  EXPECT_THAT(LeftOn(lab[1]), IsEmpty());
}

TEST_F(SshHostsTest, EndOnBothSidesOfACableThatStaysCut) {
  const SshLab lab(2);
  stall_timeout_s_ = "3";
  Background run(RunFrom(lab[0], lab.ssh(), OnLab2({"fusion", "acc"}), {"--pace", "20"}));
  ASSERT_TRUE(IsUnderWay()) << run.Err();
  lab.lab().Unplug(1);
  EXPECT_EQ(run.Wait(), 3);
  EXPECT_THAT(run.Err(), HasSubstr("; lab2 has not answered for "));
  // The other machine receives nothing from the runner, and ends its roles 15 s after the stall
  // timeout.
  EXPECT_THAT(LeftOn(lab[1]), IsEmpty());
}

TEST_F(SshHostsTest, NameADeadMachine) {
  const SshLab lab(2);
  EXPECT_THAT(Failure(lab, "lab3"),
              AllOf(StartsWith("fogline run: error: lab3: ssh lab3 failed\n"),
                    HasSubstr("\n  lab3: ssh: connect to host 10.76.67.3 port 2222: ")));
}

TEST_F(SshHostsTest, NameAMachineWithAnotherVersion) {
  const SshLab lab(2);
  const ScratchFolder folder;
  const std::string other = MakeOtherVersion(folder.File("fogline"));
  const Outcome outcome =
      RunCommand(RunFrom(lab[0], lab.ssh(), {"--on", "acc=lab2:" + folder.path().string()}));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err,
              StartsWith("fogline run: error: lab2: fogline there is " + other + ", here "));
}

TEST_F(SshHostsTest, RefuseAtOnceAMachineThatAsksForAPassword) {
  SshLab lab(2);
  lab.ForgetTheUser();
  EXPECT_THAT(
      Failure(lab, "lab2"),
      AllOf(StartsWith("fogline run: error: lab2: ssh lab2 failed; it must let this user in "
                       "with a key: ssh-copy-id lab2\n"),
            HasSubstr("\n  lab2: root@10.76.67.2: Permission denied (publickey,password")));
}

TEST_F(SshHostsTest, RefuseAMachineWithAnUnknownHostKey) {
  const SshLab lab(2);
  lab.ForgetTheHosts();
  EXPECT_THAT(Failure(lab, "lab2"),
              StartsWith("fogline run: error: lab2: ssh lab2 failed; make its host key known: ssh "
                         "lab2 true\n"));
}

TEST_F(SshHostsTest, SayThatTheProgramsAreNotInThePath) {
  const SshLab lab(2);
  const Outcome outcome = RunCommand(RunFrom(lab[0], lab.ssh(), {"--on", "acc=lab2"}));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(
      outcome.err,
      StartsWith("fogline run: error: lab2: there is no fogline in the PATH there; name its "
                 "folder: --on ROLE=HOST:/FOLDER"));
}

TEST_F(SshHostsTest, EndWithin5sOfCtrlC) {
  const SshLab lab(2);
  ExpectCtrlCEndsEverything(lab.lab(), lab.ssh(), std::chrono::seconds(5));
}

TEST_F(SshHostsTest, LeaveNothingBehindAfterTheRunnersDeath) {
  const SshLab lab(2);
  ExpectNothingIsLeftOfARunnerThatWasKilled(lab.lab(), lab.ssh());
}

TEST_F(SshHostsTest, UseTheRelayWhereThereIsNoMulticast) {
  const SshLab lab(2);
  ExpectTheRelayCarriesARunWithoutMulticast(lab.lab(), lab.ssh());
}

TEST_F(SshHostsTest, CarryTheRelayThroughTheirOwnConnection) {
  // The recipe of docs/laboratory.md for a network that permits only ssh.
  const SshLab lab(2);
  BlockUdpBetween(lab.lab());
  const Outcome run =
      RunCommand(RunFrom(lab[0], lab.ssh() + " -R 7700:127.0.0.1:7700", OnLab2({"fusion", "acc"}),
                         {"--relay-at", "127.0.0.1:7700"}));
  EXPECT_EQ(Result(run)["digest"], Undisturbed());
}

}  // namespace
}  // namespace fogline::test
