// A node's part in a run, by the example of the driver: TRUTH in, DRIVER_COMMAND out.
#include "services/runtime/node.h"

#include <gtest/gtest.h>

#include "services/driver/driver.h"
#include "services/runtime/step_node.h"
#include "tests/unit/runtime/script.h"

namespace fogline {
namespace {

using test::Script;

class NodeTest : public testing::Test {
 protected:
  truth_t Truth(std::int64_t step) {
    auto truth = Script::Of<truth_t>(step);
    truth.host_gap_m = 40;
    truth.host_speed_mps = 20 + 0.01 * static_cast<double>(step);
    return truth;
  }
  /// What an honest network gives to who has asked: every step of every request.
  void AnswerRequests() {
    while (served_ < requests_.size()) {
      const resend_t request = requests_[served_++];
      if (request.channel != "TRUTH") continue;
      for (std::int64_t k = 0; k < request.count; ++k) {
        script_.Say(Truth(request.header.step + k));
      }
      script_.Poll(node_);
    }
  }

  Script script_;
  std::vector<resend_t>& requests_ = script_.Listen<resend_t>();
  std::vector<driver_command_t>& commands_ = script_.Listen<driver_command_t>();
  std::vector<status_t>& status_ = script_.Listen<status_t>();
  StepNode<Driver> node_{script_.bus(), Script::kRunId};
  std::size_t served_ = 0;
};

TEST_F(NodeTest, AsksForTheScenarioOfItsRunUnasked) {
  script_.Poll(node_);
  ASSERT_EQ(requests_.size(), 1U);
  EXPECT_EQ(requests_[0].channel, "RUN");
}

TEST_F(NodeTest, AsksForOneStepAtATimeWhenItIsInStep) {
  script_.SayRun(run_t::GO, -1);
  script_.Say(Truth(0));
  // WHEN somebody wants to know what it cannot know yet
  script_.AskFor("DRIVER_COMMAND", 1, 1);
  // THEN it asks for what it needs for that
  ASSERT_EQ(requests_.size(), 2U);
  EXPECT_EQ(requests_[1].channel, "TRUTH");
  EXPECT_EQ(requests_[1].header.step, 1);
  EXPECT_EQ(requests_[1].count, 1);
}

TEST_F(NodeTest, WaitsBeforeItAsksForAStepThatMayBeOnItsWay) {
  script_.SayRun(run_t::GO, -1);
  script_.Say(Truth(0));
  script_.Say(Truth(2));
  script_.Poll(node_);
  EXPECT_TRUE(requests_.empty());
  script_.Poll(node_, Clock::now() + milliseconds(60));
  ASSERT_EQ(requests_.size(), 1U);
  EXPECT_EQ(requests_[0].header.step, 1);
  EXPECT_EQ(requests_[0].count, 1) << "step 2 is there";
}

TEST_F(NodeTest, CatchesUpManyStepsAtATimeAndInSilence) {
  constexpr std::int64_t kProgress = 200;
  script_.SayRun(run_t::GO, kProgress);
  script_.Poll(node_);
  // GIVEN that it asks at once for as much as its ring holds
  ASSERT_EQ(requests_.size(), 1U);
  EXPECT_EQ(requests_[0].header.step, 0);
  EXPECT_EQ(requests_[0].count, kRingSteps - 1);
  // WHEN it gets that, and so on
  AnswerRequests();
  // THEN it comes to where the others are, without asking for anything twice
  script_.Say(Truth(kProgress + 1));
  ASSERT_EQ(requests_.size(), 4U);
  std::int64_t next = 0;
  for (const resend_t& request : requests_) {
    EXPECT_EQ(request.header.step, next);
    next += request.count;
  }
  EXPECT_EQ(next, kProgress + 1);
  // AND says only what the recorder does not answer for
  ASSERT_FALSE(commands_.empty());
  EXPECT_EQ(commands_.front().header.step, kProgress - kRingSteps + 1);
  EXPECT_EQ(commands_.back().header.step, kProgress + 1);
  EXPECT_EQ(commands_.size(), static_cast<std::size_t>(kRingSteps + 1));
}

TEST_F(NodeTest, CountsNoStepAsImpossibleThatIsUnderWayWhileItCatchesUp) {
  script_.SayRun(run_t::GO, 200);
  script_.Say(Truth(200));
  script_.Say(Truth(200 + kRingSteps));
  script_.Poll(node_, Clock::now() + milliseconds(500));
  EXPECT_EQ(status_.back().out_of_window, 0);
  script_.Say(Truth(1'000'000));
  script_.Poll(node_, Clock::now() + milliseconds(1000));
  EXPECT_EQ(status_.back().out_of_window, 1);
}

TEST_F(NodeTest, AsksAgainForWhatIsLostOnTheWay) {
  script_.SayRun(run_t::GO, 30);
  script_.Poll(node_);
  for (std::int64_t k = 0; k <= 30; ++k) {
    if (k != 5 && k != 9) script_.Say(Truth(k));
  }
  script_.Poll(node_);
  EXPECT_EQ(requests_.size(), 1U) << "it may be on its way";
  script_.Poll(node_, Clock::now() + milliseconds(10));
  ASSERT_EQ(requests_.size(), 2U);
  EXPECT_EQ(requests_[1].header.step, 5);
  EXPECT_EQ(requests_[1].count, 5) << "5 to 9";
}

TEST_F(NodeTest, AnswersARangeFromItsRing) {
  script_.SayRun(run_t::GO, -1);
  for (std::int64_t k = 0; k < 10; ++k) script_.Say(Truth(k));
  const std::vector<driver_command_t> said = commands_;
  commands_.clear();
  script_.AskFor("DRIVER_COMMAND", 2, 5);
  ASSERT_EQ(commands_.size(), 5U);
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    EXPECT_EQ(commands_[i].header.step, said[i + 2].header.step);
    EXPECT_EQ(commands_[i].acceleration_mps2, said[i + 2].acceleration_mps2);
  }
  commands_.clear();
  script_.AskFor("DRIVER_COMMAND", 3, 0);  // from somebody who knows no ranges
  EXPECT_EQ(commands_.size(), 1U);
}

TEST_F(NodeTest, AnswersAFloodOfRequestsWithAFewMessages) {
  script_.SayRun(run_t::GO, -1);
  for (std::int64_t k = 0; k < kRingSteps; ++k) script_.Say(Truth(k));
  commands_.clear();
  constexpr int kRequests = 200;
  const TimePoint began = Clock::now();
  for (int i = 0; i < kRequests; ++i) script_.AskFor("DRIVER_COMMAND", 0, 1'000'000'000);
  const std::chrono::duration<double> took = Clock::now() - began;
  // 500 at once and 2000 a second, of 12,800.
  EXPECT_GE(commands_.size(), 500U);
  EXPECT_LE(static_cast<double>(commands_.size()), 501 + 2000 * took.count());
}

}  // namespace
}  // namespace fogline
