#include "common/own_pauses.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

TimePoint At(int at_ms) { return TimePoint{} + milliseconds(1'000'000 + at_ms); }

TEST(OwnPausesTest, AreNotHeldAgainstOthers) {
  OwnPauses pauses(At(0));
  pauses.Attend(At(400));
  pauses.Attend(At(20'400));
  pauses.Attend(At(20'500));
  EXPECT_EQ(pauses.HeldAgainst(At(0), At(20'500)), milliseconds(500));
  EXPECT_EQ(pauses.HeldAgainst(At(20'450), At(20'500)), milliseconds(50));
  // If the last message of a process came during the pause, the rest of the pause does not count as
  // silence of the process.
  EXPECT_EQ(pauses.HeldAgainst(At(10'000), At(20'500)), milliseconds(100));
  EXPECT_EQ(pauses.TakeLongest(), milliseconds(20'000));
  EXPECT_EQ(pauses.TakeLongest(), Duration::zero());
}

TEST(OwnPausesTest, AreLongerThanAProcessWaits) {
  OwnPauses pauses(At(0));
  for (int at_ms = 0; at_ms <= 20'000; at_ms += 200) pauses.Attend(At(at_ms));
  EXPECT_EQ(pauses.HeldAgainst(At(0), At(20'000)), milliseconds(20'000));
  EXPECT_EQ(pauses.TakeLongest(), Duration::zero());
}

}  // namespace
}  // namespace fogline
