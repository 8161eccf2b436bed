// For some time, messages of a run cannot be sent: an interface, its address or its route is
// removed and restored, or a firewall drops outgoing messages. Each test has a network that the
// kernel simulates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <set>
#include <thread>

#include "common/clock.h"
#include "services/log/event_log.h"
#include "services/runtime/node/runner_watch.h"
#include "services/runtime/transport/multicast_route.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

/// A failure of the network, and the shell commands that begin and end the failure.
struct Outage {
  std::string name;
  std::string begin;
  std::string end;
};
void PrintTo(const Outage& outage, std::ostream* out) { *out << outage.name; }

const char* const kFirewall =
    "nft 'table inet reload { chain out { type filter hook output priority 0; policy drop; }; }'";

/// Tests on one machine with an interface to another network.
class OutageTest : public NetworkTest {
 protected:
  static void SetUpInterface(const Machine& machine) {
    machine.Do(
        "ip link add eth0 type veth peer name peer0; ip addr add 192.0.2.1/24 dev eth0;"
        "ip link set eth0 up; ip link set peer0 up; ip route add default via 192.0.2.2");
  }
  /// A run of 5 s. Its time limits are longer than any outage of these tests.
  std::vector<std::string> PacedRun(std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--pace", "10"});
    return Run(more);
  }
  /// Waits until the log of the run has grown by about fifty steps.
  void LastForSteps() const {
    ASSERT_TRUE(GrowsTo(std::filesystem::file_size(Log()) + 50'000, Log()));
  }
  /// Waits for a fixed time, because no event shows when a process has noticed an outage.
  static void LastFor(Duration time) { std::this_thread::sleep_for(time); }
};

class OwnMachineOutageTest : public OutageTest, public testing::WithParamInterface<Outage> {};

TEST_P(OwnMachineOutageTest, IsNothingToARunThatStaysOnItsMachine) {
  const Machine machine("alone");
  SetUpInterface(machine);
  Background run(machine.On(PacedRun()));
  ASSERT_TRUE(GrowsTo(20'000, Log()));
  machine.Do(GetParam().begin);
  LastForSteps();
  machine.Do(GetParam().end);
  const auto result = ResultOf(run);
  EXPECT_EQ(result["digest"], Undisturbed());
  EXPECT_TRUE(result["failed_sends"].empty()) << result["failed_sends"];
}

INSTANTIATE_TEST_SUITE_P(
    Of, OwnMachineOutageTest,
    testing::Values(Outage{"TheRoute", "ip route del default",
                           "ip route add default via 192.0.2.2"},
                    Outage{"TheAddress", "ip addr flush dev eth0",
                           "ip addr add 192.0.2.1/24 dev eth0; ip route add default via 192.0.2.2"},
                    Outage{"TheLink", "ip link set eth0 down",
                           "ip link set eth0 up; ip route add default via 192.0.2.2"},
                    Outage{"TheInterface", "ip link del eth0", "true"}),
    [](const auto& outage) { return outage.param.name; });

class SeveralMachinesOutageTest : public OutageTest, public testing::WithParamInterface<Outage> {};

TEST_P(SeveralMachinesOutageTest, IsRepairedAndTold) {
  // GIVEN a run with its driver on another machine
  const Lab lab(2);
  Background driver(lab[1].On({Program("fogline-driver"), "--lcm-url", kUrl}));
  Background run(lab[0].On(PacedRun({"--lcm-url", kUrl, "--external", "driver"})));
  ASSERT_TRUE(GrowsTo(20'000, Log()));
  // WHEN a part of the network fails on the driver's machine and comes back
  lab[1].Do(GetParam().begin);
  // The run now waits for the driver. The driver tries to send a STATUS every 200 ms, or later on a
  // busy machine. No event shows this test that a message was lost. So the test waits 4 s, which is
  // enough for several messages.
  std::this_thread::sleep_for(milliseconds(4000));
  lab[1].Do(GetParam().end);
  // THEN the result is that of an undisturbed run
  const auto result = ResultOf(run);
  EXPECT_EQ(result["digest"], Undisturbed());
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  // AND the result names the role that could not send, and the reason
  ASSERT_EQ(result["failed_sends"].size(), 1U) << result["failed_sends"];
  EXPECT_EQ(result["failed_sends"][0]["role"], "driver");
  EXPECT_GT(result["failed_sends"][0]["count"], 0);
  EXPECT_NE(result["failed_sends"][0]["error"], "");
}

constexpr const char* kRouteAgain = "ip route add 239.0.0.0/8 dev eth0";
const std::string kAddressAgain = std::string("ip addr add 10.76.67.2/24 dev eth0; ") + kRouteAgain;
const std::string kLinkAgain = std::string("ip link set eth0 up; ") + kRouteAgain;

INSTANTIATE_TEST_SUITE_P(
    Of, SeveralMachinesOutageTest,
    testing::Values(Outage{"TheRoute", "ip route del 239.0.0.0/8", kRouteAgain},
                    Outage{"TheAddress", "ip addr flush dev eth0", kAddressAgain},
                    Outage{"TheLink", "ip link set eth0 down", kLinkAgain},
                    Outage{"TheFirewall", kFirewall, "nft delete table inet reload"}),
    [](const auto& outage) { return outage.param.name; });

TEST_F(OutageTest, ARoleThatIsStartedWhileTheNetworkIsAwayWaitsForIt) {
  const Machine machine("alone");
  machine.RouteMulticastToItself();
  Background run(machine.On(PacedRun({"--lcm-url", kUrl})));
  ASSERT_TRUE(GrowsTo(20'000, Log()));
  // WHEN a role is killed and started again while the machine has no route for multicast
  machine.Do("ip route del 239.0.0.0/8");
  kill(PidOf(run.Err(), "fusion"), SIGKILL);
  EXPECT_TRUE(run.WaitForErr("started again as pid ")) << run.Err();
  // No event shows that the new process has found no route, so the test waits for a fixed time.
  LastFor(milliseconds(500));
  machine.RouteMulticastToItself();
  // THEN the new process continues from the step of the old process
  const auto result = ResultOf(run);
  EXPECT_EQ(result["digest"], Undisturbed());
  ASSERT_EQ(result["restarts"].size(), 1U) << result["restarts"];
  EXPECT_EQ(result["restarts"][0]["role"], "fusion");
  EXPECT_EQ(result["restarts"][0]["count"], 1);
}

TEST_F(OutageTest, ARoleThatWaitsForTheNetworkSaysSoAndCanBeInterrupted) {
  const Machine machine("alone");
  Background driver(machine.On({Program("fogline-driver"), "--run-id", "5", "--lcm-url", kUrl}));
  ASSERT_TRUE(driver.WaitForErr("waits for the network")) << driver.Err();
  EXPECT_THAT(driver.Err(), HasSubstr("no route for multicast"));
  driver.Signal(SIGTERM);
  EXPECT_EQ(driver.Wait(), 130) << driver.Err();
  const Outcome outcome = RunCommand(
      machine.On({Program("fogline-driver"), "--run-id", "5", "--lcm-url", kUrl, "--wait", "0.2"}));
  EXPECT_EQ(outcome.code, 2) << outcome.err;
}

TEST_F(OutageTest, AFirewallThatDropsOneOfAThousandEndsNoRun) {
  // GIVEN a machine with a route for multicast, so that a run may choose any transport. A firewall
  // drops one of a thousand outgoing UDP datagrams
  const Machine machine("firewall");
  machine.RouteMulticastToItself();
  machine.Do(
      "nft 'table inet outage { chain out { type filter hook output priority 0;"
      " meta l4proto udp numgen inc mod 1000 < 1 drop; }; }'");
  const auto result = Result(RunCommand(machine.On(Run({}))));
  EXPECT_EQ(result["digest"], Undisturbed());
  EXPECT_FALSE(result["failed_sends"].empty()) << "of 4500 messages and more";
}

TEST_F(OutageTest, AFirewallThatLetsNothingInIsNamedAtTheStart) {
  const Lab lab(1);
  lab[0].Do(
      "nft 'table inet filter { chain input { type filter hook input priority filter; policy drop; "
      "ct state established,related accept; }; }'");
  for (const std::string url : {kUrl, "udpm://239.255.76.67:7700"}) {
    const Outcome run =
        RunCommand(lab[0].On({Program("fogline"), "run", "scenario/paper.json", "--lcm-url", url}));
    EXPECT_EQ(run.code, 2) << run.err;
    EXPECT_THAT(run.err, HasSubstr("a message to 239.255.76.67:7700 does not come back to this "
                                   "machine: perhaps a firewall drops it"));
  }
}

TEST_F(OutageTest, AFirewallThatDropsWhatIsSentChangesNoResultAndIsTold) {
  const Machine machine("firewall");
  machine.RouteMulticastToItself();
  machine.Do(
      "nft 'table inet outage { chain out { type filter hook output priority 0;"
      " meta l4proto udp numgen random mod 100 < 5 drop; }; }'");
  const auto result = Result(RunCommand(machine.On(Run({}))));
  EXPECT_EQ(result["digest"], Undisturbed());
  ASSERT_FALSE(result["failed_sends"].empty());
  std::int64_t failed = 0;
  for (const auto& one : result["failed_sends"]) {
    failed += one["count"].get<std::int64_t>();
    EXPECT_EQ(one["error"], "Operation not permitted");
  }
  EXPECT_GT(failed, 50) << "of 4500 messages and more";
  // AND the printed text names these messages, too
  const Outcome text = RunCommand(
      machine.On({Program("fogline"), "run", "scenario/paper.json", "--log", Log() + ".text"}));
  EXPECT_THAT(text.out, ContainsRegex("\nmessages that could not be sent: .*world [0-9]+.* "
                                      "\\(Operation not permitted\\)\n"));
}

TEST_F(OutageTest, AFirewallThatLetsNothingOutEndsTheRunWithItsReason) {
  const Machine machine("firewall");
  Background run(machine.On({Program("fogline"), "run", "scenario/paper.json", "--pace", "1",
                             "--stall-timeout", "5", "--restarts", "0", "--log", Log()}));
  ASSERT_TRUE(GrowsTo(20'000, Log()));
  machine.Do(kFirewall);
  EXPECT_EQ(run.Wait(), 3);
  // The run may first notice that it cannot send messages, or that it receives no messages.
  EXPECT_THAT(run.Err(),
              AllOf(ContainsRegex("(nothing could be sent for [0-9]+\\.[0-9] s: |messages that "
                                  "could not be sent: .*)\\(?Operation not permitted"),
                    HasSubstr("the log so far: " + Log())));
}

TEST_F(OutageTest, ARoleInRealtimeThatCouldSendNothingForLongGoesOn) {
  // GIVEN a run in real time with a stall timeout of one second and its driver on another machine
  const Lab lab(2);
  Background driver(lab[1].On({Program("fogline-driver"), "--lcm-url", kUrl}));
  Background run(lab[0].On({Program("fogline"), "run", "scenario/paper.json", "--json",
                            "--realtime", "--set", "/steps=100", "--external", "driver",
                            "--lcm-url", kUrl, "--stall-timeout", "1", "--log", Log()}));
  ASSERT_TRUE(GrowsTo(20'000, Log()));
  // WHEN the driver can send nothing for longer than this timeout
  lab[1].Do(kFirewall);
  LastFor(milliseconds(1800));
  lab[1].Do("nft delete table inet reload");
  // THEN the driver takes part until the end, and the run reports the messages that the driver
  // could not send
  run.Wait();
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  const auto result = nlohmann::json::parse(run.Out(), nullptr, false);
  ASSERT_TRUE(result.is_object()) << run.Err();
  ASSERT_EQ(result["failed_sends"].size(), 1U) << result["failed_sends"];
  EXPECT_EQ(result["failed_sends"][0]["error"], "Operation not permitted");
}

TEST_F(OutageTest, ARoleThatCouldSendNothingWhileItWaitedTakesPart) {
  // GIVEN a driver that can send nothing while it waits for a run, for longer than the stall
  // timeout
  const Lab lab(2);
  stall_timeout_s_ = "4";
  Background driver(lab[1].On({Program("fogline-driver"), "--lcm-url", kUrl}));
  ASSERT_TRUE(driver.WaitForErr("waiting for a run")) << driver.Err();
  lab[1].Do(kFirewall);
  LastFor(milliseconds(5000));
  // WHEN a run calls it, and the driver can send again a second later
  Background run(lab[0].On(Run({"--lcm-url", kUrl, "--external", "driver"})));
  ASSERT_TRUE(run.WaitForErr("waiting for the driver")) << run.Err();
  LastFor(milliseconds(1000));  // the runner sends RUN every 50 ms
  lab[1].Do("nft delete table inet reload");
  // THEN the driver takes part in this run
  EXPECT_EQ(ResultOf(run)["digest"], Undisturbed());
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST_F(OutageTest, ARoleThatWasToldNoNetworkOutlivesThatOfItsRun) {
  // GIVEN a driver that may join any announced run, and that takes part in a run over an interface
  const Machine machine("lab");
  SetUpInterface(machine);
  Background driver(
      machine.On({"env", std::string("LCM_DEFAULT_URL=") + kUrl, Program("fogline-driver")}));
  Background run(
      machine.On(PacedRun({"--lcm-url", kUrl, "--external", "driver", "--restarts", "0"})));
  ASSERT_TRUE(GrowsTo(20'000, Log()));
  // WHEN the driver receives nothing from its runner for so long that the driver looks for another
  // run
  machine.Do("ip addr flush dev eth0");
  LastFor(runtime::RunnerWatch::kSilent + milliseconds(1000));
  machine.Do("ip addr add 192.0.2.1/24 dev eth0; ip route add default via 192.0.2.2");
  // THEN the driver continues with its own run
  EXPECT_EQ(ResultOf(run)["digest"], Undisturbed());
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

TEST_F(OutageTest, AGroupIsLeftOnTheInterfaceToWhichTheRouteLedBefore) {
  const Machine machine("lab");
  machine.Do(
      "for i in 0 1; do ip link add eth$i type veth peer name peer$i;"
      " ip addr add 192.0.$i.1/24 dev eth$i; ip link set eth$i up; ip link set peer$i up; done;"
      "ip route add 239.0.0.0/8 dev eth0");
  const auto has_group = [&machine](const std::string& interface) {
    return runtime::HasGroup(machine.Do("cat /proc/net/igmp"), interface, "239.255.76.67");
  };
  // The driver joins the group of kUrl. The driver also sends to the meeting address, which has the
  // same group. The socket that only sends must not join the group, because it would stay in the
  // group on eth0.
  const Background driver(machine.On({Program("fogline-driver"), "--lcm-url", kUrl}));
  const TimePoint end = Clock::now() + kPatience;
  while (!has_group("eth0") && Clock::now() < end) LastFor(milliseconds(50));
  EXPECT_TRUE(has_group("eth0")) << driver.Err();
  machine.Do("ip route replace 239.0.0.0/8 dev eth1");
  while (!has_group("eth1") && Clock::now() < end) LastFor(milliseconds(50));
  EXPECT_TRUE(has_group("eth1"));
  EXPECT_FALSE(has_group("eth0"));
}

/// The steps of TRUTH in a log that a program has written or is writing.
std::set<std::int64_t> StepsIn(const std::string& log) {
  std::set<std::int64_t> steps;
  log::EventLogReader reader(log);
  while (const auto event = reader.Next()) {
    if (event->channel == "TRUTH")
      steps.insert(runtime::ReadInt64(event->data, runtime::kStepOffset));
  }
  return steps;
}

std::int64_t LastStepIn(const std::string& log) {
  const std::set<std::int64_t> steps = StepsIn(log);
  return steps.empty() ? -1 : *steps.rbegin();
}

TEST_F(OutageTest, LeavesStockProgramsThatHearARunAndAreHeard) {
  // GIVEN Debian's lcm-logger, which joins the group on the interface of the default route
  const Machine machine("lab");
  SetUpInterface(machine);
  const std::string url = "udpm://239.255.76.67:7700?ttl=0";
  const std::string stock = Log() + ".stock";
  Background logger(
      machine.On({"lcm-logger", "--quiet", "--flush-interval=10", "--lcm-url=" + url, stock}));
  // lcm-logger listens when this socket exists. The kernel prints the port 7700 as 1E14.
  machine.Do("until grep -q :1E14 /proc/net/udp; do sleep 0.01; done");
  // WHEN a run takes place on loopback and the interface goes down during the run
  Background run(machine.On(Run({"--lcm-url", url, "--pace", "5"})));
  ASSERT_TRUE(GrowsTo(100'000, Log()));
  machine.Do("ip link set eth0 down");
  LastForSteps();
  machine.Do("ip link set eth0 up; ip route add default via 192.0.2.2");
  EXPECT_EQ(ResultOf(run)["digest"], Undisturbed());
  // lcm-logger writes messages later than they are sent. When it ends, it drops messages that it
  // has not written. So the test waits until the log has one of the last 100 steps.
  const TimePoint end = Clock::now() + kPatience;
  while (LastStepIn(stock) < 400 && Clock::now() < end) {
    LastFor(milliseconds(50));
  }
  logger.Signal(SIGINT);
  EXPECT_EQ(logger.Wait(), 0);
  // THEN lcm-logger has logged the whole run, except messages that it loses when the machine is
  // busy
  const std::set<std::int64_t> steps = StepsIn(stock);
  EXPECT_GT(steps.size(), 250U);
  for (std::int64_t step = 0; step < 500; step += 100) {
    EXPECT_NE(steps.lower_bound(step), steps.lower_bound(step + 100)) << step;
  }
  // AND top receives the messages of lcm-logplayer, which sends over the interface of the route
  Background top(machine.On(
      {Program("fogline"), "top", "--json", "--once", "--interval", "10", "--lcm-url", url}));
  machine.Do("until grep -q :1E14 /proc/net/udp; do sleep 0.01; done");
  Background player(machine.On({"lcm-logplayer", "--speed=10", "--lcm-url=" + url, stock}));
  EXPECT_EQ(top.Wait(), 0) << top.Err();
  EXPECT_THAT(top.Out(), HasSubstr("\"TRACK\""));
}

}  // namespace
}  // namespace fogline::test
