#include "tools/watch/step_sequence.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>

#include "tests/unit/tools/watch/now.h"

namespace fogline {
namespace {

watch::StepSequence Seen(std::initializer_list<std::int64_t> steps) {
  watch::StepSequence sequence;
  for (const std::int64_t step : steps) sequence.Add(step, kNow);
  return sequence;
}

/// Adds the steps from `first` to `last`.
void AddRange(watch::StepSequence& sequence, std::int64_t first, std::int64_t last,
              TimePoint now = kNow) {
  for (std::int64_t step = first; step <= last; ++step) sequence.Add(step, now);
}

TEST(StepSequenceTest, LosesNothingOfACompleteSequenceWhereverItBegins) {
  watch::StepSequence sequence;
  AddRange(sequence, 300, 800);
  const auto counts = sequence.counts();
  EXPECT_EQ(counts.newest, 800);
  EXPECT_EQ(counts.lost + counts.missing + counts.late + counts.duplicate + counts.stray, 0);
}

TEST(StepSequenceTest, CallsAGapMissingUntilItLeavesTheWindowAndLostThen) {
  watch::StepSequence sequence = Seen({0, 1, 2, 5});
  EXPECT_EQ(sequence.counts().missing, 2);
  EXPECT_EQ(sequence.counts().lost, 0);
  // Step 3 is in the window as long as the newest step is below 3 + kWindow.
  AddRange(sequence, 6, 3 + watch::StepSequence::kWindow - 1);
  EXPECT_EQ(sequence.counts().missing, 2);
  EXPECT_EQ(sequence.counts().lost, 0);
  sequence.Add(3 + watch::StepSequence::kWindow, kNow);
  EXPECT_EQ(sequence.counts().missing, 1);
  EXPECT_EQ(sequence.counts().lost, 1);
  sequence.Add(4 + watch::StepSequence::kWindow, kNow);
  EXPECT_EQ(sequence.counts().missing, 0);
  EXPECT_EQ(sequence.counts().lost, 2);
}

TEST(StepSequenceTest, LosesNothingThatIsRepairedInTheWindow) {
  watch::StepSequence sequence = Seen({0, 1, 3, 4, 2});
  EXPECT_EQ(sequence.counts().missing, 0);
  EXPECT_EQ(sequence.counts().late, 1);
  AddRange(sequence, 5, 500);
  EXPECT_EQ(sequence.counts().lost, 0);
  EXPECT_EQ(sequence.counts().duplicate, 0);
}

TEST(StepSequenceTest, CountsEveryCopyOnceAndNoCopyAsLate) {
  const auto counts = Seen({0, 1, 1, 2, 0, 2, 3}).counts();
  EXPECT_EQ(counts.duplicate, 3);
  EXPECT_EQ(counts.late, 0);
  EXPECT_EQ(counts.missing, 0);
}

TEST(StepSequenceTest, CountsAGapWiderThanTheWindowStepByStep) {
  // Steps 0 and 200 were seen, steps 1 to 199 were not. Steps up to 200 - kWindow are lost; the
  // later steps are missing.
  const auto counts = Seen({0, 200}).counts();
  EXPECT_EQ(counts.lost, 200 - watch::StepSequence::kWindow);
  EXPECT_EQ(counts.missing, watch::StepSequence::kWindow - 1);
}

TEST(StepSequenceTest, DoesNotCountWhatCameBeforeTheFirstStepSeenAsLost) {
  watch::StepSequence sequence = Seen({100, 98, 101});
  EXPECT_EQ(sequence.counts().late, 1);
  AddRange(sequence, 102, 400);
  EXPECT_EQ(sequence.counts().lost, 0);
}

TEST(StepSequenceTest, IgnoresOneForgedStepFarAhead) {
  constexpr std::int64_t kForged = std::int64_t{1} << 62;
  watch::StepSequence sequence = Seen({0, 1, kForged, 2, -7, 3});
  EXPECT_EQ(sequence.counts().newest, 3);
  EXPECT_EQ(sequence.counts().stray, 2);
  EXPECT_EQ(sequence.counts().lost + sequence.counts().missing, 0);
}

TEST(StepSequenceTest, IgnoresTwoForgedStepsFarAheadWithAStepBetweenThem) {
  watch::StepSequence sequence = Seen({0, 1, 5000, 2, 5001, 3});
  EXPECT_EQ(sequence.counts().newest, 3);
  EXPECT_EQ(sequence.counts().stray, 2);
}

TEST(StepSequenceTest, FollowsASequenceThatGoesOnFarAhead) {
  watch::StepSequence sequence = Seen({0, 1, 50'000, 50'001, 50'002});
  EXPECT_EQ(sequence.counts().newest, 50'002);
  EXPECT_EQ(sequence.counts().stray, 1);
  EXPECT_EQ(sequence.counts().lost, 0);
}

TEST(StepSequenceTest, SurvivesTheLargestSteps) {
  constexpr std::int64_t kLargest = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(Seen({kLargest, kLargest - 1}).counts().newest, -1);
  const auto counts =
      Seen({0, kLargest - 1, kLargest, std::numeric_limits<std::int64_t>::min()}).counts();
  EXPECT_EQ(counts.newest, 0);
  EXPECT_EQ(counts.stray, 3);
}

TEST(StepSequenceTest, TakesOldStepsForCopiesWhileTheRunGoesOn) {
  // Steps 0 to 100 come twice, because the recorder sends them again for a role that was restarted.
  watch::StepSequence sequence;
  AddRange(sequence, 0, 300);
  AddRange(sequence, 0, 100);
  EXPECT_EQ(sequence.counts().newest, 300);
  EXPECT_EQ(sequence.counts().duplicate, 101);
}

TEST(StepSequenceTest, BeginsAgainWithALogThatIsPlayedTwice) {
  watch::StepSequence sequence;
  AddRange(sequence, 0, 300);
  AddRange(sequence, 0, 200, kNow + watch::StepSequence::kBeginsAgain);
  EXPECT_EQ(sequence.counts().newest, 200);
  EXPECT_EQ(sequence.counts().lost + sequence.counts().missing + sequence.counts().duplicate, 0);
}

}  // namespace
}  // namespace fogline
