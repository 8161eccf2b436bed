// Processes of a run are away for longer than any of them waits for another by default: stopped by
// Ctrl-Z, frozen with their container, or behind a cable that is out.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "common/clock.h"
#include "services/runtime/lockstep/runner_watch.h"
#include "tests/support/children.h"
#include "tests/support/network_test.h"

namespace fogline::test {
namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:7700?ttl=1";
// Longer than a role waits for its runner.
constexpr auto kAway = runtime::RunnerWatch::kGone + milliseconds(2000);

/// A run with its driver on another machine.
struct RunOnTwoMachines {
  const Lab& lab;
  const Background& run;
  const Background& driver;
};

/// The processes or the cable that go away and come back, and the options with which a run allows
/// for that.
struct Absence {
  std::string name;
  std::vector<std::string> options;
  std::function<void(const RunOnTwoMachines&)> begin;
  std::function<void(const RunOnTwoMachines&)> end;
};
void PrintTo(const Absence& absence, std::ostream* out) { *out << absence.name; }

// The option for an absence that is longer than a run waits for a role by default.
const std::vector<std::string> kWaitLonger{"--stall-timeout", "60"};

Absence Stopped(std::string name, std::vector<std::string> options,
                std::vector<pid_t> (*processes)(const RunOnTwoMachines&)) {
  const auto signal = [processes](int number) {
    return [processes, number](const RunOnTwoMachines& run) {
      for (const pid_t pid : processes(run)) kill(pid, number);
    };
  };
  return {.name = std::move(name),
          .options = std::move(options),
          .begin = signal(SIGSTOP),
          .end = signal(SIGCONT)};
}

const Absence kEverything = Stopped("everything", {}, [](const RunOnTwoMachines& run) {
  std::vector<pid_t> all = ChildrenOf(run.run.pid());
  all.insert(all.end(), {run.run.pid(), run.driver.pid()});
  return all;
});
const Absence kRunner = Stopped(
    "runner", {}, [](const RunOnTwoMachines& run) { return std::vector<pid_t>{run.run.pid()}; });
const Absence kDriver = Stopped("driver", kWaitLonger, [](const RunOnTwoMachines& run) {
  return std::vector<pid_t>{run.driver.pid()};
});
const Absence kCable = {.name = "cable",
                        .options = kWaitLonger,
                        .begin = [](const RunOnTwoMachines& run) { run.lab.Unplug(1); },
                        .end = [](const RunOnTwoMachines& run) { run.lab.Plug(1); }};

class AwayTest : public NetworkTest, public testing::WithParamInterface<Absence> {};

TEST_P(AwayTest, CostsNoRunThatWaitsForLonger) {
  const Lab lab(2);
  Background driver(lab[1].On({Program("fogline-driver"), "--lcm-url", kUrl}));
  // A run of five seconds. Something goes away after the first of them.
  const ScratchFolder folder;
  const std::string log = folder.File("run.lcm");
  std::vector<std::string> command{Program("fogline"),
                                   "run",
                                   "scenario/paper.json",
                                   "--json",
                                   "--external",
                                   "driver",
                                   "--lcm-url",
                                   kUrl,
                                   "--pace",
                                   "10",
                                   "--log",
                                   log};
  command.insert(command.end(), GetParam().options.begin(), GetParam().options.end());
  Background run(lab[0].On(command));
  ASSERT_TRUE(run.WaitForErr("waiting for the driver")) << run.Err();
  ASSERT_TRUE(GrowsTo(20'000, log)) << run.Err();
  const RunOnTwoMachines both{.lab = lab, .run = run, .driver = driver};
  GetParam().begin(both);
  std::this_thread::sleep_for(kAway);  // longer than a role waits, which is what is tested
  GetParam().end(both);
  const auto result = ResultOf(run);
  EXPECT_EQ(result["digest"], Undisturbed());
  EXPECT_EQ(result["steps"], 500);
  EXPECT_TRUE(result["restarts"].empty()) << result["restarts"];
  EXPECT_EQ(driver.Wait(), 0) << driver.Err();
}

INSTANTIATE_TEST_SUITE_P(Some, AwayTest, testing::Values(kEverything),
                         [](const auto& absence) { return absence.param.name; });
INSTANTIATE_TEST_SUITE_P(Campaign, AwayTest, testing::Values(kRunner, kDriver, kCable),
                         [](const auto& absence) { return absence.param.name; });

}  // namespace
}  // namespace fogline::test
