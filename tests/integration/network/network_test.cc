// The lockstep on networks that the kernel simulates: the machines have their own addresses, and
// some of the networks lose messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <deque>
#include <map>
#include <set>
#include <thread>

#include "common/clock.h"
#include "services/graph.h"
#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

using testing::HasSubstr;

TEST_F(NetworkTest, LosingThreeOfTenDatagramsInTheKernelChangesNoResult) {
  const Machine machine("lossy");
  machine.RouteMulticastToItself();
  machine.LoseUdp(30);
  const auto run = Result(RunCommand(machine.On(Run({}))));
  EXPECT_EQ(run["steps"], 500);
  EXPECT_EQ(run["digest"], Undisturbed());
  EXPECT_GT(machine.LostUdp(), 1000);
  EXPECT_GT(run["repairs"], 500);
}

/// Three machines. Every role except the recorder is started by hand on one of these machines.
class ThreeMachinesTest : public NetworkTest {
 protected:
  nlohmann::json RunOn(const Lab& lab, std::vector<std::string> more) {
    std::deque<Background> roles;
    const std::map<Role, std::size_t> places{
        {Role::kWorld, 1}, {Role::kRadar, 2},  {Role::kLidar, 1},      {Role::kFusion, 2},
        {Role::kAcc, 0},   {Role::kDriver, 1}, {Role::kArbitrator, 2}, {Role::kFollower, 0}};
    for (const auto& [role, place] : places) {
      const std::string name(NameOf(role));
      roles.emplace_back(lab[place].On({Program("fogline-" + name), "--lcm-url", kUrl}));
      more.insert(more.end(), {"--external", name});
    }
    more.insert(more.end(), {"--lcm-url", kUrl});
    const auto result = Result(RunCommand(lab[0].On(Run(more))));
    for (Background& role : roles) EXPECT_EQ(role.Wait(), 0) << role.Err();
    return result;
  }
};

TEST_F(ThreeMachinesTest, RunTheSameWhenEveryRoleIsStartedByHand) {
  const Lab lab(3);
  const auto run = RunOn(lab, {});
  EXPECT_EQ(run["steps"], 500);
  EXPECT_EQ(run["digest"], Undisturbed());
}

TEST_F(ThreeMachinesTest, RunTheSameWhenEachLosesThreeOfTenDatagrams) {
  const Lab lab(3);
  for (const Machine& machine : lab.machines()) machine.LoseUdp(30);
  const auto run = RunOn(lab, {"--set", "/steps=80"});
  EXPECT_EQ(run["steps"], 80);
  EXPECT_EQ(run["digest"], Undisturbed({"--set", "/steps=80"}));
  for (const Machine& machine : lab.machines()) EXPECT_GT(machine.LostUdp(), 150);
  EXPECT_GT(run["repairs"], 80);
}

TEST_F(ThreeMachinesTest, RunTheSameWhenTheSwitchSendsHalfOfTheDatagramsTwice) {
  const Lab lab(3);
  try {
    lab.RepeatUdp(50);
  } catch (const std::runtime_error& error) {
    return MachineLacks(std::string("a kernel that repeats datagrams: ") + error.what());
  }
  const auto run = RunOn(lab, {});
  EXPECT_EQ(run["digest"], Undisturbed());
  EXPECT_GT(lab.RepeatedUdp(), 1000);
}

TEST_F(ThreeMachinesTest, RunTheSameWhenTheLinksDelayRepeatAndReorder) {
  const Lab lab(3);
  for (const Machine& machine : lab.machines()) {
    const Outcome netem =
        RunCommand(machine.On({"tc", "qdisc", "add", "dev", "eth0", "root", "netem", "delay", "5ms",
                               "3ms", "reorder", "20%", "duplicate", "10%"}));
    // Some kernels lack the module netem, although they can do everything that NetworkTest needs.
    if (netem.code != 0) GTEST_SKIP() << "the kernel has no netem: " << netem.err;
  }
  const auto run = RunOn(lab, {"--set", "/steps=80"});
  EXPECT_EQ(run["digest"], Undisturbed({"--set", "/steps=80"}));
}

/// Two runs on two machines of one network, or on one machine. The parameter is the index of the
/// second run's machine.
class TwoRunsTest : public NetworkTest, public testing::WithParamInterface<std::size_t> {};

TEST_P(TwoRunsTest, OnOneGroupAndPortDoNotMix) {
  const Lab lab(2);
  // GIVEN a run that takes 10 s
  Background paced(lab[0].On(Run({"--lcm-url", kUrl, "--set", "/steps=150", "--pace", "1.5"})));
  ASSERT_TRUE(paced.WaitForErr("processes: "));
  // WHEN another run takes place at the same time. Its seed makes the messages of the two runs
  // differ from the first step on, so a message of the wrong run would change a digest
  const auto other =
      Result(RunCommand(lab[GetParam()].On(Run({"--lcm-url", kUrl, "--seed", "7"}))));
  // THEN each run has the same result as when it runs alone
  EXPECT_EQ(other["digest"], Undisturbed({"--seed", "7"}));
  const auto first = ResultOf(paced);
  EXPECT_EQ(first["digest"], Undisturbed({"--set", "/steps=150"}));
  // AND each run has refused messages of the other run, and the first run names the senders of
  // these messages
  EXPECT_GT(first["refused"]["foreign"], 500);
  EXPECT_GT(other["refused"]["foreign"], 0);
  EXPECT_EQ(first["strangers"].size(), kRoles.size());
  for (const auto& peer : first["strangers"]) {
    EXPECT_EQ(peer["host"], lab[GetParam()].name());
  }
}

INSTANTIATE_TEST_SUITE_P(Together, TwoRunsTest, testing::Values(0U, 1U), [](const auto& place) {
  return place.param == 0 ? "OnOneMachine" : "OnTwoMachines";
});

TEST_F(NetworkTest, AProcessThatIsBoundToAnotherRunIsIgnoredAndNamed) {
  const Lab lab(2);
  Background stale(lab[1].On({Program("fogline-driver"), "--lcm-url", kUrl, "--run-id", "123"}));
  // The runner can name the driver only after a message of the driver has come, and the driver may
  // start late. So the run takes 5 s.
  Background run(lab[0].On(Run({"--lcm-url", kUrl, "--pace", "10"})));
  const auto result = ResultOf(run);
  EXPECT_EQ(result["digest"], Undisturbed());
  ASSERT_EQ(result["strangers"].size(), 1U);
  EXPECT_EQ(result["strangers"][0], nlohmann::json::parse(R"({"role": "driver", "host": "lab2",
      "run_id": 123, "pid": )" + std::to_string(stale.pid()) +
                                                          "}"));
  EXPECT_THAT(run.Err(), HasSubstr("ignored: driver (pid " + std::to_string(stale.pid()) +
                                   " on lab2) of run 123\n"));
}

TEST_F(NetworkTest, ARoleWhoseRunnerHasDiedTakesNoPartInTheNextRun) {
  const Lab lab(2);
  // GIVEN a run with its driver on another machine, and a runner that is killed
  Background orphan(lab[1].On({Program("fogline-driver"), "--lcm-url", kUrl}));
  Background first(lab[0].On(Run({"--lcm-url", kUrl, "--external", "driver", "--pace", "1"})));
  ASSERT_TRUE(first.WaitForErr("waiting for the driver"));
  // The log has a dozen steps, so the driver takes part.
  ASSERT_TRUE(GrowsTo(20'000, Log()));
  const std::string id = first.Err().substr(4, first.Err().find(" on ") - 4);
  first.Signal(SIGKILL);
  first.Wait();
  // WHEN another run takes place with a driver of its own
  Background second(lab[0].On(Run({"--lcm-url", kUrl, "--pace", "10"})));
  // THEN the old driver changes nothing
  EXPECT_EQ(ResultOf(second)["digest"], Undisturbed());
  EXPECT_THAT(second.Err(), HasSubstr("ignored: driver (pid " + std::to_string(orphan.pid()) +
                                      " on lab2) of run " + id + "\n"));
}

TEST_F(NetworkTest, OfTwoProcessesThatAreToldTheRunTheFirstHasTheRoleAndTheOtherEnds) {
  const Lab lab(3);
  Background run(lab[0].On(Run({"--lcm-url", kUrl, "--external", "driver", "--pace", "10"})));
  ASSERT_TRUE(run.WaitForErr("waiting for the driver"));
  const std::string id = run.Err().substr(4, run.Err().find(" on ") - 4);
  std::deque<Background> drivers;
  for (const std::size_t place : {1U, 2U}) {
    drivers.emplace_back(
        lab[place].On({Program("fogline-driver"), "--lcm-url", kUrl, "--run-id", id}));
  }
  const auto result = ResultOf(run);
  EXPECT_EQ(result["digest"], Undisturbed());
  EXPECT_EQ(result["restarts"].size(), 0U) << result["restarts"];
  std::multiset<int> codes;
  for (Background& driver : drivers) codes.insert(driver.Wait());
  EXPECT_EQ(codes, (std::multiset<int>{0, 3})) << drivers[0].Err() << drivers[1].Err();
  EXPECT_THAT(drivers[0].Err() + drivers[1].Err(),
              HasSubstr("error: another process is the driver of run " + id + "\n"));
}

TEST_F(NetworkTest, AProcessWithTheKeyThatComesLaterIsRefusedToo) {
  const Lab lab(2);
  const ScratchFolder keys;
  const std::string key = keys.File("key");
  ASSERT_EQ(RunCommand({Program("fogline"), "keygen", key}).code, 0);
  Background run(lab[0].On(Run({"--lcm-url", kUrl, "--pace", "10", "--key", key})));
  ASSERT_TRUE(run.WaitForErr("processes: "));
  const std::string id = run.Err().substr(4, run.Err().find(" on ") - 4);
  Background stray(
      lab[1].On({Program("fogline-driver"), "--lcm-url", kUrl, "--run-id", id, "--key", key}));
  EXPECT_EQ(stray.Wait(), 3);
  EXPECT_EQ(ResultOf(run)["digest"], Undisturbed());
}

TEST_F(NetworkTest, OfTwoProcessesOfOneRoleOneTakesPartAndTheOtherWaits) {
  const Lab lab(3);
  std::deque<Background> drivers;
  for (const std::size_t place : {1U, 2U}) {
    drivers.emplace_back(lab[place].On({Program("fogline-driver"), "--lcm-url", kUrl}));
    ASSERT_TRUE(drivers.back().WaitForErr("waiting for a run"));
  }
  const auto result =
      Result(RunCommand(lab[0].On(Run({"--lcm-url", kUrl, "--external", "driver"}))));
  EXPECT_EQ(result["digest"], Undisturbed());
  EXPECT_EQ(result["restarts"].size(), 0U) << result["restarts"];
  const auto ended = [&] {
    return std::ranges::count_if(drivers,
                                 [](const Background& one) { return !IsAlive(one.pid()); });
  };
  // The runner does not wait until its driver has ended, so the test waits for the end of the
  // driver. Even on a busy machine the driver ends within kPatience.
  const TimePoint end = Clock::now() + kPatience;
  while (ended() == 0 && Clock::now() < end) std::this_thread::sleep_for(kLookEvery);
  EXPECT_EQ(ended(), 1);
}

TEST_F(NetworkTest, AMachineThatGoesEndsWhatStillRunsOnIt) {
  pid_t left = 0;
  {
    const Machine machine("left");
    left = std::stoi(machine.Do("setsid sleep 300 < /dev/null > /dev/null 2>&1 & echo $!"));
    EXPECT_TRUE(IsAlive(left));
  }
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (IsAlive(left) && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_FALSE(IsAlive(left));
}

TEST_F(NetworkTest, AMachineWithoutAMulticastRouteRunsAsAnyOther) {
  const Machine machine("island");
  const Outcome run = RunCommand(machine.On(Run({})));
  const auto result = Result(run);
  EXPECT_EQ(result["transport"], "udpm");
  EXPECT_EQ(result["digest"], Undisturbed());
  EXPECT_EQ(LinesBesideDelays(run.err), 2) << run.err;
  // AND a table runs on this machine, too
  const Outcome table = RunCommand(machine.On(
      {Program("fogline"), "table", "scenario/paper.json", "--transport", "udpm", "--json"}));
  EXPECT_EQ(table.code, 0) << table.err;
  EXPECT_EQ(table.err, "");
  // AND a role finds a run although it gets no URL
  Background waiting(machine.On({Program("fogline-driver")}));
  ASSERT_TRUE(waiting.WaitForErr("waiting for a run"));
  EXPECT_EQ(Result(RunCommand(machine.On(Run({"--external", "driver"}))))["digest"], Undisturbed());
  EXPECT_EQ(waiting.Wait(), 0) << waiting.Err();
}

TEST_F(NetworkTest, AMachineWithoutAMulticastRouteIsToldWhichOneAnUrlNeeds) {
  const Machine machine("island");
  for (const auto& command :
       {Run({"--lcm-url", kUrl}),
        std::vector<std::string>{Program("fogline-driver"), "--lcm-url", kUrl}}) {
    const Outcome outcome = RunCommand(machine.On(command));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("error: this machine has no route for multicast to 239.255."
                                       "76.67; as root: \"ip route add 239.0.0.0/8 dev lo\""));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  }
  // AND the run succeeds if only this route is added
  machine.Do("ip route add 239.0.0.0/8 dev lo");
  EXPECT_EQ(Result(RunCommand(machine.On(Run({}))))["digest"], Undisturbed());
}

TEST_F(NetworkTest, OfSeveralInterfacesTheRouteChoosesOne) {
  // GIVEN two machines, each with a default route that does not lead to the other machine
  const Lab lab(2);
  for (const Machine& machine : lab.machines()) {
    machine.Do(
        "ip link add wan0 type veth peer name wan1; ip addr add 192.0.2.1/24 dev wan0;"
        "ip link set wan0 up; ip link set wan1 up; ip route add default via 192.0.2.2");
  }
  Background driver(lab[1].On({Program("fogline-driver"), "--lcm-url", kUrl}));
  const auto run = Result(RunCommand(lab[0].On(Run({"--lcm-url", kUrl, "--external", "driver"}))));
  EXPECT_EQ(run["digest"], Undisturbed());
}

}  // namespace
}  // namespace fogline::test
