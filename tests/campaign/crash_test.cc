// Each role hangs in a run of its own. In other runs a hundred processes are killed at random
// steps.
#include <gtest/gtest.h>

#include "tests/integration/faults/killed_roles.h"

namespace fogline::test {
namespace {

TEST(CrashTest, AHundredKillsAtRandomStepsChangeNoResult) {
  ExpectKillsAtRandomStepsChangeNoResult(100);
}

class HangTest : public testing::TestWithParam<std::string> {};

TEST_P(HangTest, IsDetectedAndMended) { ExpectHangersAreStartedAgain({GetParam()}); }

INSTANTIATE_TEST_SUITE_P(EveryRole, HangTest, testing::ValuesIn(AllRoles()),
                         [](const auto& role) { return role.param; });

}  // namespace
}  // namespace fogline::test
