// RealtimeWatch, the common part of the rules by which roles compute in real time: messages,
// inputs, and steps that are due.
#include "services/runtime/realtime/realtime_watch.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include "tests/unit/services/runtime/node/fake_role.h"
#include "tests/unit/services/runtime/realtime/run_times.h"

namespace fogline {
namespace {

using test::Script;
using testing::ElementsAre;
using Verdict = runtime::StepRing::Verdict;

class RealtimeWatchTest : public test::FakeRoleInRun {
 protected:
  RealtimeWatchTest() {
    Join(-1, kSlowSpeed);
    watch_.emplace(parts_, Scenario());
  }
  static std::vector<std::uint8_t> Truth(std::int64_t step, double gap_m = 0) {
    auto truth = Script::Of<truth_t>(step);
    truth.host_gap_m = gap_m;
    std::vector<std::uint8_t> bytes;
    runtime::Encode(truth, bytes);
    return bytes;
  }
  /// The input gets its message of a step.
  void Hear(std::int64_t step) {
    runtime::Arrival arrival;
    const std::vector<std::uint8_t> bytes = Truth(step);
    arrival.Renew(bytes, Clock::now());
    watch_->Take(0, step, arrival);
  }

  std::optional<runtime::RealtimeWatch> watch_;
};

TEST_F(RealtimeWatchTest, TakesAStepOnceAndAStepThatCannotBeUnderWayNever) {
  EXPECT_EQ(watch_->Judge(0, 0, Truth(0)), Verdict::kNew);
  Hear(0);
  EXPECT_TRUE(parts_.inputs.all()[0].ring.Has(0));
  EXPECT_EQ(watch_->Judge(0, 0, Truth(0)), Verdict::kDuplicate);
  EXPECT_EQ(watch_->Judge(0, 0, Truth(0, 40)), Verdict::kLate);
  EXPECT_EQ(watch_->Judge(0, 100, Truth(100)), Verdict::kOutOfWindow);
}

TEST_F(RealtimeWatchTest, CountsAMessageThatComesAfterTheEndOfItsStep) {
  parts_.steps.StartAt(1);
  const TimePoint now = Clock::now();
  EXPECT_FALSE(watch_->Speaks(0, now));
  EXPECT_EQ(watch_->Judge(0, 0, Truth(0)), Verdict::kLate);
  EXPECT_TRUE(watch_->Speaks(0, now)) << "it speaks, but too late";
  watch_->WriteStatus(Clock::now());
  EXPECT_THAT(parts_.own.message().input, ElementsAre("TRUTH"));
  EXPECT_THAT(parts_.own.message().input_late, ElementsAre(1));
}

TEST_F(RealtimeWatchTest, KnowsTheNewestStepByWhatItHears) {
  EXPECT_EQ(watch_->horizon().newest(), -1);
  Hear(1);
  EXPECT_EQ(watch_->horizon().newest(), 1);
  EXPECT_EQ(watch_->StateOf(0), InputState::kOk);
}

TEST_F(RealtimeWatchTest, CountsTheStepsThatAreLeftOut) {
  const TimePoint now = Clock::now();
  watch_->ComputeDue(0, now, now);
  watch_->ComputeDue(3, now, now);
  EXPECT_THAT(role_.computed, ElementsAre(0, 3));
  EXPECT_EQ(watch_->statistics().deadline_misses(), 2);
  EXPECT_EQ(watch_->statistics().ticks(), 2);
}

TEST_F(RealtimeWatchTest, CountsNoTickOfAStepThatFails) {
  role_.compute_error = "no number";
  const TimePoint now = Clock::now();
  watch_->ComputeDue(0, now, now);
  EXPECT_EQ(watch_->statistics().ticks(), 0);
  EXPECT_TRUE(parts_.own.left());
}

TEST_F(RealtimeWatchTest, LooksForStepsThatAreDueOnlyWhileTheRoleRuns) {
  int calls = 0;
  const auto fire = [&calls](TimePoint now) {
    ++calls;
    return now + milliseconds(7);
  };
  const TimePoint now = Clock::now();
  EXPECT_GE(watch_->Poll(now, fire), now + milliseconds(7));
  EXPECT_EQ(calls, 1);
  parts_.own.Leave();
  watch_->Poll(now, fire);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace fogline
