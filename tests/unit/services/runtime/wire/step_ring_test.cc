#include "services/runtime/wire/step_ring.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

using runtime::StepRing;
const std::vector<std::uint8_t> kA{1, 2, 3};
const std::vector<std::uint8_t> kB{1, 2, 4};

TEST(StepRingTest, TakesAStepOnce) {
  runtime::StepRing ring;
  EXPECT_EQ(ring.Classify(0, kA, 0), StepRing::Verdict::kNew);
  ring.Store(0, kA);
  EXPECT_EQ(ring.Classify(0, kA, 0), StepRing::Verdict::kDuplicate);
  EXPECT_TRUE(std::ranges::equal(ring.Get(0), kA));
}

TEST(StepRingTest, NamesTheSameStepWithOtherBytesAConflictEvenAfterItWasUsed) {
  runtime::StepRing ring;
  ring.Store(5, kA);
  EXPECT_EQ(ring.Classify(5, kB, 5), StepRing::Verdict::kConflict);
  EXPECT_EQ(ring.Classify(5, kB, 20), StepRing::Verdict::kConflict);
}

TEST(StepRingTest, TakesStepsInAnyOrderWithinItsWindow) {
  runtime::StepRing ring;
  ring.Store(3, kA);
  EXPECT_EQ(ring.Classify(2, kA, 2), StepRing::Verdict::kNew);
  EXPECT_EQ(ring.Classify(2 + runtime::kRingSteps - 1, kA, 2), StepRing::Verdict::kNew);
  EXPECT_EQ(ring.Classify(2 + runtime::kRingSteps, kA, 2), StepRing::Verdict::kOutOfWindow);
  EXPECT_EQ(ring.newest(), 3);
}

TEST(StepRingTest, CallsWhatIsBehindTheReaderADuplicate) {
  runtime::StepRing ring;
  EXPECT_EQ(ring.Classify(4, kA, 5), StepRing::Verdict::kDuplicate);
}

TEST(StepRingTest, ForgetsAStepOnlyWhenOneFullRingLaterArrives) {
  runtime::StepRing ring;
  ring.Store(1, kA);
  ring.Store(runtime::kRingSteps, kB);
  EXPECT_TRUE(ring.Has(1));
  ring.Store(1 + runtime::kRingSteps, kB);
  EXPECT_FALSE(ring.Has(1));
}

}  // namespace
}  // namespace fogline
