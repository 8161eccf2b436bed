// A hundred runners are killed at random steps. On each of two transports, a hundred runs in one
// process are killed, too. Each run is continued, and must have the same result as a run that was
// not killed.
#include <gtest/gtest.h>

#include "tests/integration/faults/resume_fixture.h"

namespace fogline::test {
namespace {

TEST_F(ResumeAfterKillTest, RunnersKilledAtRandomStepsChangeNoResult) {
  ExpectKilledRunnersChangeNoResult(100);
}

TEST_F(ResumeAfterKillTest, RunsInOneProcessGoOnToTheSameResult) {
  ExpectKilledProcessesGoOnToTheSameResult(100);
}

}  // namespace
}  // namespace fogline::test
