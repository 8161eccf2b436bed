// One part of a run is away for longer than any other part waits for it by default: a process that
// is stopped, or a machine whose cable is out.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/integration/network/away.h"

namespace fogline::test {
namespace {

// The user announces an absence with this option if it is longer than a run waits for a role by
// default.
const std::vector<std::string> kWaitLonger{"--stall-timeout", "60"};

const Absence kRunner = Stopped(
    "runner", {}, [](const RunOnTwoMachines& run) { return std::vector<pid_t>{run.run.pid()}; });
const Absence kDriver = Stopped("driver", kWaitLonger, [](const RunOnTwoMachines& run) {
  return std::vector<pid_t>{run.driver.pid()};
});
const Absence kCable = {.name = "cable",
                        .options = kWaitLonger,
                        .begin = [](const RunOnTwoMachines& run) { run.lab.Unplug(1); },
                        .end = [](const RunOnTwoMachines& run) { run.lab.Plug(1); }};

TEST_P(AwayTest, CostsNoRunThatWaitsForLonger) { ExpectAbsenceCostsNoRun(GetParam()); }

INSTANTIATE_TEST_SUITE_P(EachPart, AwayTest, testing::Values(kRunner, kDriver, kCable),
                         [](const auto& absence) { return absence.param.name; });

}  // namespace
}  // namespace fogline::test
