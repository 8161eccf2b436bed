// All processes of a run are stopped for longer than the default stall timeout. Ctrl-Z stops a run
// in this way, and the freezing of a container stops the runs in it.
#include <gtest/gtest.h>

#include <vector>

#include "tests/integration/network/away.h"
#include "tests/support/children.h"

namespace fogline::test {
namespace {

const Absence kEverything = Stopped("everything", {}, [](const RunOnTwoMachines& run) {
  std::vector<pid_t> all = ChildrenOf(run.run.pid());
  all.insert(all.end(), {run.run.pid(), run.driver.pid()});
  return all;
});

TEST_P(AwayTest, CostsNoRunThatWaitsForLonger) { ExpectAbsenceCostsNoRun(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Some, AwayTest, testing::Values(kEverything),
                         [](const auto& absence) { return absence.param.name; });

}  // namespace
}  // namespace fogline::test
