// Tests in which processes or a machine of a run are unreachable for longer than the default stall
// timeout of 4 s.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <ostream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/clock.h"
#include "services/runtime/node/runner_watch.h"
#include "tests/support/network_test.h"

namespace fogline::test {

inline constexpr const char* kAwayUrl = "udpm://239.255.76.67:7700?ttl=1";
// The duration of an absence: 17 s. By default a role waits for a silent runner for 19 s: for the
// stall timeout and then for kGone. So the absence ends before a role leaves the run.
inline constexpr auto kAway = runtime::RunnerWatch::kGone + milliseconds(2000);

/// A run with its driver on another machine.
struct RunOnTwoMachines {
  const Lab& lab;
  const Background& run;
  const Background& driver;
};

/// The processes or the machine that are unreachable, and the options by which the user tells the
/// run to wait for them.
struct Absence {
  std::string name;
  std::vector<std::string> options;
  std::function<void(const RunOnTwoMachines&)> begin;
  std::function<void(const RunOnTwoMachines&)> end;
};
inline void PrintTo(const Absence& absence, std::ostream* out) { *out << absence.name; }

/// Processes that are stopped.
inline Absence Stopped(std::string name, std::vector<std::string> options,
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

class AwayTest : public NetworkTest, public testing::WithParamInterface<Absence> {
 protected:
  /// Makes a run in whose middle the absence begins and ends. The result must be that of an
  /// undisturbed run.
  void ExpectAbsenceCostsNoRun(const Absence& absence) {
    const Lab lab(2);
    Background driver(lab[1].On({Program("fogline-driver"), "--lcm-url", kAwayUrl}));
    // A run of five seconds. The absence begins after a dozen steps.
    const ScratchFolder folder;
    const std::string log = folder.File("run.lcm");
    std::vector<std::string> command{Program("fogline"),
                                     "run",
                                     "scenario/paper.json",
                                     "--json",
                                     "--external",
                                     "driver",
                                     "--lcm-url",
                                     kAwayUrl,
                                     "--pace",
                                     "10",
                                     "--log",
                                     log};
    command.insert(command.end(), absence.options.begin(), absence.options.end());
    Background run(lab[0].On(command));
    ASSERT_TRUE(run.WaitForErr("waiting for the driver")) << run.Err();
    ASSERT_TRUE(GrowsTo(20'000, log)) << run.Err();
    const RunOnTwoMachines both{.lab = lab, .run = run, .driver = driver};
    absence.begin(both);
    std::this_thread::sleep_for(kAway);  // the test is about this pause
    absence.end(both);
    const auto result = ResultOf(run);
    EXPECT_EQ(result["digest"], Undisturbed());
    EXPECT_EQ(result["steps"], 500);
    EXPECT_TRUE(result["restarts"].empty()) << result["restarts"];
    EXPECT_EQ(driver.Wait(), 0) << driver.Err();
  }
};

}  // namespace fogline::test
