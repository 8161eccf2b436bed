// A part of a run is unreachable for longer than the default stall timeout. The part is a stopped
// process, or a machine with an unplugged cable.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/integration/network/away.h"

namespace fogline::test {
namespace {

// With this option a run waits longer for its roles. A user needs this option if roles may be
// unreachable for longer than the default stall timeout.
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
