#include "services/runtime/coordination/restart_policy.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(RestartPolicyTest, WaitsTwiceAsLongEachTimeThatItDoesNotHelpUpToASecond) {
  runtime::RestartPolicy policy(10);
  for (const int wait_ms : {10, 20, 40, 80, 160, 320, 640, 1000, 1000, 1000}) {
    EXPECT_EQ(policy.OnDeath(217), milliseconds(wait_ms));
  }
}

TEST(RestartPolicyTest, StartsOverWhenTheRunHasMadeProgress) {
  runtime::RestartPolicy policy(10);
  policy.OnDeath(217);
  policy.OnDeath(217);
  EXPECT_EQ(policy.OnDeath(218), runtime::RestartPolicy::kShortest);
}

TEST(RestartPolicyTest, CountsEveryRestartWhetherItHelpsOrNot) {
  runtime::RestartPolicy policy(2);
  EXPECT_TRUE(policy.OnDeath(1));
  EXPECT_TRUE(policy.OnDeath(2));
  EXPECT_FALSE(policy.OnDeath(3));
  EXPECT_EQ(policy.restarts(), 2);
  EXPECT_FALSE(runtime::RestartPolicy(0).OnDeath(0));
}

TEST(RestartPolicyTest, TriesAgainEverLaterWhatCannotBeStartedAndCountsThatForNothing) {
  runtime::RestartPolicy policy(1);
  EXPECT_EQ(policy.OnDeath(1), milliseconds(10));
  for (const int wait_ms : {20, 40, 80, 160, 320, 640, 1000, 1000}) {
    EXPECT_EQ(policy.OnFailedStart(), milliseconds(wait_ms));
  }
  EXPECT_EQ(policy.restarts(), 1);
}

}  // namespace
}  // namespace fogline
