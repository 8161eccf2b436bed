// The times at which a role computes in lockstep, and the requests that the role sends.
#include "services/runtime/lockstep/lockstep_rule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "services/acc/acc.h"
#include "services/world/world.h"
#include "tests/unit/services/runtime/driver_in_run.h"

namespace fogline {
namespace {

using test::Script;
using LockstepRuleTest = test::DriverInRun;

TEST_F(LockstepRuleTest, AsksForOneStepAtATimeWhenItIsInStep) {
  script_.SayRun(run_t::GO, -1);
  script_.Say(Truth(0));
  // WHEN another role requests an output, and the node lacks the input for this output
  script_.AskFor("DRIVER_COMMAND", 1, 1);
  // THEN the node requests this input
  ASSERT_EQ(requests_.size(), 2U);
  EXPECT_EQ(requests_[1].channel, "TRUTH");
  EXPECT_EQ(requests_[1].header.step, 1);
  EXPECT_EQ(requests_[1].count, 1);
}

TEST_F(LockstepRuleTest, WaitsBeforeItAsksForAStepThatMayBeOnItsWay) {
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

TEST_F(LockstepRuleTest, CatchesUpManyStepsAtATimeAndInSilence) {
  constexpr std::int64_t kProgress = 200;
  script_.SayRun(run_t::GO, kProgress);
  script_.Poll(node_);
  // GIVEN a node that requests, with one message, all steps for which its ring buffer has room
  ASSERT_EQ(requests_.size(), 1U);
  EXPECT_EQ(requests_[0].header.step, 0);
  EXPECT_EQ(requests_[0].count, runtime::kRingSteps - 1);
  // WHEN the node gets the requested steps, and all steps that it requests next
  AnswerRequests();
  // THEN the node reaches the step of the other roles, and has requested each step once
  script_.Say(Truth(kProgress + 1));
  ASSERT_EQ(requests_.size(), 4U);
  std::int64_t next = 0;
  for (const resend_t& request : requests_) {
    EXPECT_EQ(request.header.step, next);
    next += request.count;
  }
  EXPECT_EQ(next, kProgress + 1);
  // AND the node publishes only its newest outputs, because the recorder has the older outputs
  ASSERT_FALSE(commands_.empty());
  EXPECT_EQ(commands_.front().header.step, kProgress - runtime::kRingSteps + 1);
  EXPECT_EQ(commands_.back().header.step, kProgress + 1);
  EXPECT_EQ(commands_.size(), static_cast<std::size_t>(runtime::kRingSteps + 1));
}

TEST_F(LockstepRuleTest, CountsNoStepAsImpossibleThatIsUnderWayWhileItCatchesUp) {
  script_.SayRun(run_t::GO, 200);
  script_.Say(Truth(200));
  script_.Say(Truth(200 + runtime::kRingSteps));
  script_.Poll(node_, Clock::now() + milliseconds(500));
  EXPECT_EQ(status_.back().out_of_window, 0);
  script_.Say(Truth(1'000'000));
  script_.Poll(node_, Clock::now() + milliseconds(1000));
  EXPECT_EQ(status_.back().out_of_window, 1);
}

TEST_F(LockstepRuleTest, AsksAgainForWhatIsLostOnTheWay) {
  script_.SayRun(run_t::GO, 30);
  script_.Poll(node_);
  const TimePoint before = Clock::now();  // before the messages come, also on a slow machine
  for (std::int64_t k = 0; k <= 30; ++k) {
    if (k != 5 && k != 9) script_.Say(Truth(k));
  }
  script_.Poll(node_, before);
  EXPECT_EQ(requests_.size(), 1U) << "it may be on its way";
  script_.Poll(node_, Clock::now() + milliseconds(10));
  ASSERT_EQ(requests_.size(), 2U);
  EXPECT_EQ(requests_[1].header.step, 5);
  EXPECT_EQ(requests_[1].count, 5) << "5 to 9";
}

// A role with two inputs. While it catches up, one of the inputs may come sooner than the other.
TEST(LockstepRuleOfTheAccTest, AsksForNoStepThatIsThere) {
  Script script;
  std::vector<resend_t>& requests = script.Listen<resend_t>();
  runtime::StepNode<acc::Acc> acc(script.bus(), Script::kRunId);
  script.SayRun(run_t::GO, 200);
  script.Poll(acc);
  // GIVEN a role that has the first four steps of TRACK, and no step of HOST_EGO
  for (std::int64_t k = 0; k < 4; ++k) script.Say(Script::Of<track_t>(k));
  requests.clear();
  // WHEN the role asks again
  script.Poll(acc, Clock::now() + milliseconds(1000));
  // THEN it asks for all steps of HOST_EGO, and for the other steps of TRACK
  std::map<std::string, std::int64_t> first;
  for (const resend_t& request : requests) first[request.channel] = request.header.step;
  EXPECT_THAT(first, testing::ElementsAre(testing::Pair("HOST_EGO", 0), testing::Pair("TRACK", 4)));
}

// ---- the world, which begins the steps ---------------------------------------------------------

class LockstepOfTheWorldTest : public testing::Test {
 protected:
  void SayCommands(std::int64_t step) {
    script_.Say(Script::Of<arbitration_t>(step));
    SayFollowers(step);
  }
  void SayFollowers(std::int64_t step) {
    auto command = Script::Of<follower_command_t>(step);
    command.num_followers = static_cast<std::int32_t>(Scenario().followers.count);
    command.acceleration_mps2.resize(Scenario().followers.count);
    command.safe_distance_m.resize(Scenario().followers.count);
    script_.Say(command);
  }
  std::vector<std::int64_t> Begun() const {
    std::vector<std::int64_t> steps;
    for (const truth_t& truth : truths_) steps.push_back(truth.header.step);
    return steps;
  }

  Script script_;
  std::vector<truth_t>& truths_ = script_.Listen<truth_t>();
  runtime::StepNode<world::World> world_{script_.bus(), Script::kRunId};
};

TEST_F(LockstepOfTheWorldTest, BeginsTheFirstStepAtGoAndEachOtherWithTheCommandsOfTheOneBefore) {
  script_.SayRun(run_t::PREPARE, -1);
  script_.Poll(world_);
  EXPECT_THAT(Begun(), testing::IsEmpty());
  script_.SayRun(run_t::GO, -1);
  EXPECT_THAT(Begun(), testing::ElementsAre(0));
  script_.Say(Script::Of<arbitration_t>(0));
  EXPECT_THAT(Begun(), testing::ElementsAre(0));
  SayFollowers(0);
  EXPECT_THAT(Begun(), testing::ElementsAre(0, 1));
}

TEST_F(LockstepOfTheWorldTest, IsNoFurtherAheadOfTheRecorderThanItMay) {
  script_.SayRun(run_t::GO, -1);
  for (std::int64_t step = 0; step < 2 * runtime::kMaxAhead; ++step) SayCommands(step);
  EXPECT_EQ(Begun().back(), runtime::kMaxAhead - 1);
  auto recorded = Script::Of<status_t>(3);
  recorded.role = "recorder";
  script_.Say(recorded);
  script_.Poll(world_);
  EXPECT_EQ(Begun().back(), runtime::kMaxAhead + 3);
}

}  // namespace
}  // namespace fogline
