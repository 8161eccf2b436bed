// A hundred runners are killed at random steps, and so are a hundred runs in one process for each
// of two transports.
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
