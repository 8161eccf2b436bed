#include "services/decision/take_over/take_over.h"

#include <optional>

#include <gtest/gtest.h>

#include "tests/unit/services/decision/take_over/asked_car.h"

namespace fogline::test {
namespace {

TEST_F(TakeOverTest, AsksAndHandsOverToADriverWhoAnswers) {
  Begin(Answering(2));
  EXPECT_EQ(Step().state, kDemand);
  EXPECT_NEAR(StepWhile(kDemand), 2.0, 1.5 * kStep_s);
  EXPECT_EQ(state(), kHandover);
  const take_over::TakeOverOutcome& out = Step();
  EXPECT_EQ(out.state, kRecovering);
  EXPECT_EQ(out.acceleration_mps2, -0.7);
}

// This test does not check the time of the first effective input, because TakeOverLog determines
// this time.
TEST_F(TakeOverTest, KeepsTheTimesOfARequest) {
  Begin(Answering(2.05));
  inputs_.human_wanted = false;
  for (int k = 0; k < 5; ++k) Step();
  inputs_.human_wanted = true;
  while (step_ < 32) Step();
  const take_over::TakeOverRequest& request = *take_over_->request();
  EXPECT_EQ(request.requested, 5);
  EXPECT_EQ(request.acknowledged, 26);
  EXPECT_EQ(request.transferred, 27);
  EXPECT_EQ(request.escalated, std::nullopt);
  EXPECT_EQ(request.manoeuvre, std::nullopt);
}

TEST_F(TakeOverTest, EscalatesAfterFourSeconds) {
  Begin(Answering(6));
  Step();
  EXPECT_NEAR(StepWhile(kDemand), 4.0, 1e-9);
  EXPECT_EQ(state(), kUrgentDemand);
  StepWhile(kUrgentDemand);
  EXPECT_EQ(state(), kHandover);
}

TEST_F(TakeOverTest, StopsComfortablyTenSecondsAfterARequestWithoutAnAnswer) {
  Begin(Absent());
  Step();
  StepWhile(kDemand);
  EXPECT_NEAR(StepWhile(kUrgentDemand), 10.0, 1e-9);
  EXPECT_EQ(state(), kMrmComfort);
  // A stop from 20 m/s at 1.5 m/s2 takes 13.3 s. The ramps at both ends, at 2.5 m/s3, add 0.6 s in
  // total.
  EXPECT_NEAR(StepWhile(kMrmComfort), 10.0 + 13.3 + 0.6, 0.5);
  EXPECT_EQ(state(), kMrmDone);
  EXPECT_EQ(take_over_->request()->manoeuvre, 100);
}

TEST_F(TakeOverTest, StaysLockedInStandstillForEveryDriver) {
  Begin(Absent());
  inputs_.speed_mps = 1;
  while (state() != kMrmDone && Now() < 60) Step();
  inputs_.human_wanted = false;
  inputs_.human_mps2 = 2;
  for (int k = 0; k < 1000; ++k) {
    const take_over::TakeOverOutcome& out = Step();
    ASSERT_EQ(out.state, kMrmDone);
    ASSERT_LE(out.acceleration_mps2, 0);
  }
  EXPECT_EQ(inputs_.speed_mps, 0);
}

TEST_F(TakeOverTest, StopsHardAtOnceWhenACollisionIsNear) {
  Begin(Answering(2));
  Step();
  track_ = Ahead(14.9, 10);  // time to collision 1.49 s
  EXPECT_EQ(Step().state, kMrmEmergency);
  EXPECT_NEAR(take_over_->outcome().acceleration_mps2, -0.25, 1e-12) << "2.5 m/s3, one step";
  for (int k = 0; k < 16; ++k) Step();
  EXPECT_NEAR(take_over_->outcome().acceleration_mps2, -4, 1e-12);
}

TEST_F(TakeOverTest, DoesNotCallACollisionNearBeforeItIs) {
  Begin(Answering(2));
  Step();
  track_ = Ahead(15.1, 10);
  EXPECT_EQ(Step().state, kDemand);
  track_ = Ahead(3, -10);
  EXPECT_EQ(Step().state, kDemand);
  track_ = Ahead(1, 10);
  track_.valid = false;
  EXPECT_EQ(Step().state, kDemand);
}

TEST_F(TakeOverTest, WithoutARequestLeavesANearCollisionToTheAutomation) {
  Begin(Answering(2));
  inputs_.human_wanted = false;
  track_ = Ahead(5, 10);
  inputs_.automation_mps2 = -5;
  const take_over::TakeOverOutcome& out = Step();
  EXPECT_EQ(out.state, kAutomated);
  EXPECT_EQ(out.acceleration_mps2, -5);
}

TEST_F(TakeOverTest, GivesTheWheelOnlyToADriverWhoIsReady) {
  Begin(Answering(2));
  inputs_.readiness = 0.29;
  Step();
  StepWhile(kDemand);
  EXPECT_EQ(state(), kHandover);
  for (int k = 0; k < 20; ++k) ASSERT_EQ(Step().state, kHandover);
  inputs_.readiness = 0.3;
  EXPECT_EQ(Step().state, kRecovering);
}

TEST_F(TakeOverTest, StopsForADriverWhoAnswersButIsNeverReady) {
  Begin(Answering(2));
  inputs_.readiness = 0;
  Step();
  StepWhile(kDemand);
  EXPECT_NEAR(StepWhile(kHandover), 10.0, 1e-9);
  EXPECT_EQ(state(), kMrmComfort);
}

TEST_F(TakeOverTest, GivesTheWheelToALateDriverAndNeverBackToTheAutomation) {
  Begin(Answering(12));
  while (state() != kMrmComfort) Step();
  EXPECT_NEAR(StepWhile(kMrmComfort), 12.0, 1.5 * kStep_s);
  EXPECT_EQ(state(), kRecovering);
  EXPECT_EQ(take_over_->outcome().acceleration_mps2, -0.7);
  EXPECT_EQ(take_over_->request()->acknowledged, take_over_->request()->transferred);
  inputs_.human_wanted = false;
  StepWhile(kRecovering);
  for (int k = 0; k < 1000; ++k) ASSERT_EQ(Step().state, kManual);
}

TEST_F(TakeOverTest, DoesNotWithdrawARequestThatIsNotWantedAnyMore) {
  Begin(Absent());
  Step();
  inputs_.human_wanted = false;
  StepWhile(kDemand);
  StepWhile(kUrgentDemand);
  EXPECT_EQ(state(), kMrmComfort);
}

TEST_F(TakeOverTest, ReturnsToTheAutomationWhenTheDriverHasRecoveredAndIsNotWanted) {
  Begin(Answering(2));
  Step();
  StepWhile(kDemand);
  StepWhile(kHandover);
  const double transfer_s = Now();
  inputs_.human_wanted = false;
  EXPECT_NEAR(StepWhile(kRecovering), transfer_s + 5, 1e-9);
  EXPECT_EQ(state(), kManual);
  const take_over::TakeOverOutcome& out = Step();
  EXPECT_EQ(out.state, kAutomated);
  EXPECT_EQ(out.acceleration_mps2, 0.5);
}

TEST_F(TakeOverTest, StaysWithTheDriverWhileHeIsWanted) {
  Begin(Answering(2));
  for (int k = 0; k < 2000; ++k) Step();
  EXPECT_EQ(state(), kManual);
}

TEST_F(TakeOverTest, DoesNotAccelerateWhileARequestStands) {
  Begin(Absent());
  inputs_.human_wanted = false;
  inputs_.automation_mps2 = 1;
  Step();
  inputs_.human_wanted = true;
  // The acceleration decreases at 2.5 m/s3.
  for (const double expected : {0.75, 0.5, 0.25, 0.0, 0.0}) {
    EXPECT_NEAR(Step().acceleration_mps2, expected, 1e-12);
  }
  inputs_.automation_mps2 = -2;
  EXPECT_EQ(Step().acceleration_mps2, -2) << "but it brakes as it likes";
}

TEST_F(TakeOverTest, SlowsDownWhileARequestStandsIfTheScenarioSaysSo) {
  Scenario scenario = Absent();
  scenario.arbitrator.take_over.slow_down_mps2 = 0.6;
  Begin(scenario);
  inputs_.human_wanted = true;
  inputs_.automation_mps2 = 0;
  // The deceleration grows at 2.5 m/s3.
  for (const double expected : {-0.25, -0.5, -0.6, -0.6}) {
    EXPECT_NEAR(Step().acceleration_mps2, expected, 1e-12);
  }
  inputs_.automation_mps2 = -2;
  EXPECT_EQ(Step().acceleration_mps2, -2) << "but it brakes as it likes";
}

TEST_F(TakeOverTest, BrakesNoLessThanTheAutomationWould) {
  Begin(Absent());
  inputs_.automation_mps2 = -2.5;
  inputs_.speed_mps = 60;
  while (state() != kMrmComfort) Step();
  for (int k = 0; k < 20; ++k) EXPECT_NEAR(Step().acceleration_mps2, -2.5, 1e-12);
  inputs_.automation_mps2 = -9;
  for (int k = 0; k < 20; ++k) EXPECT_GE(Step().acceleration_mps2, -4 - 1e-12);
  EXPECT_NEAR(take_over_->outcome().acceleration_mps2, -4, 1e-12);
}

TEST_F(TakeOverTest, BrakesHarderAndAtLastReportsFailureOfABrakeThatDoesNotStopTheCar) {
  Begin(Absent());
  brakes_ = false;
  while (state() != kMrmComfort) Step();
  // A stage is overdue after twice the longest time that the stage needs to stop the car. Without
  // the time that the jerk limit adds, the comfortable stage has 2 * 13.3 s (20 m/s at 1.5 m/s2).
  // The hard stage has 2 * 5 s (20 m/s at 4 m/s2).
  EXPECT_GT(StepWhile(kMrmComfort), 10 + 2 * 13.3);
  EXPECT_EQ(state(), kMrmEmergency);
  EXPECT_GT(StepWhile(kMrmEmergency), 10 + 2 * (13.3 + 5));
  EXPECT_EQ(state(), kMrmFailed);
  EXPECT_NEAR(Step().acceleration_mps2, -4, 1e-12) << "it goes on trying";
  brakes_ = true;
  StepWhile(kMrmFailed);
  EXPECT_EQ(state(), kMrmDone);
}

TEST_F(TakeOverTest, DecidesTheSameWhenStepsAreLeftOut) {
  Begin(Absent());
  Step();
  step_ = 99;
  EXPECT_EQ(Step().state, kUrgentDemand) << "the escalation only";
  EXPECT_EQ(Step().state, kMrmComfort);
}

// ---- a person who drives -----------------------------------------------------------------------

TEST_F(TakeOverTest, WaitsForTheAnswerOfAPersonAndDrawsNone) {
  Begin(WithPerson());
  EXPECT_EQ(StepWhile(kAutomated), 0);
  while (Now() < 5) Step();
  EXPECT_EQ(state(), kUrgentDemand);
  inputs_.acknowledged = true;
  EXPECT_EQ(Step().state, kHandover);
  EXPECT_EQ(take_over_->request()->acknowledged, step_ - 1);
  inputs_.acknowledged = false;
  EXPECT_EQ(Step().state, kRecovering) << "the answer holds";
}

TEST_F(TakeOverTest, DoesNotTakeWhatAPersonDidBeforeTheRequestForAnAnswer) {
  Begin(WithPerson());
  inputs_.human_wanted = false;
  inputs_.acknowledged = true;
  for (int k = 0; k < 5; ++k) EXPECT_EQ(Step().state, kAutomated);
  inputs_.acknowledged = false;
  inputs_.human_wanted = true;
  for (int k = 0; k < 20; ++k) EXPECT_EQ(Step().state, kDemand);
}

TEST_F(TakeOverTest, StopsForAPersonWhoDoesNotAnswerAndLetsALateOneDrive) {
  Begin(WithPerson());
  StepWhile(kAutomated);
  StepWhile(kDemand);
  EXPECT_NEAR(StepWhile(kUrgentDemand), 10, 1.5 * kStep_s);
  EXPECT_EQ(state(), kMrmComfort);
  for (int k = 0; k < 10; ++k) Step();
  inputs_.acknowledged = true;
  EXPECT_EQ(Step().state, kRecovering);
}

TEST_F(TakeOverTest, TakesTheAnswerOfAPersonInTheStepOfTheDeadline) {
  Begin(WithPerson());
  while (step_ < 100) Step();
  ASSERT_EQ(state(), kUrgentDemand);
  inputs_.acknowledged = true;
  EXPECT_EQ(Step().state, kHandover) << "10 s after the request in step 0";
}

TEST_F(TakeOverTest, DoesNotHandOverToAPersonWhoHasGone) {
  Begin(WithPerson());
  StepWhile(kAutomated);
  inputs_.acknowledged = true;
  EXPECT_EQ(Step().state, kHandover);
  inputs_.readiness = 0;
  EXPECT_NEAR(StepWhile(kHandover), 10, 1.5 * kStep_s);
  EXPECT_EQ(state(), kMrmComfort);
}

TEST_F(TakeOverTest, ReturnsToTheAutomationOnlyWhenAPersonGivesBack) {
  Begin(WithPerson());
  brakes_ = false;
  StepWhile(kAutomated);
  inputs_.acknowledged = true;
  StepWhile(kDemand);
  StepWhile(kHandover);
  StepWhile(kRecovering);
  ASSERT_EQ(state(), kManual);
  inputs_.gives_back = true;
  EXPECT_EQ(Step().state, kManual) << "the policy still wants the human";
  inputs_.gives_back = false;
  inputs_.human_wanted = false;
  for (int k = 0; k < 100; ++k) EXPECT_EQ(Step().state, kManual);
  inputs_.gives_back = true;
  EXPECT_EQ(Step().state, kAutomated);
}

TEST_F(TakeOverTest, AsksAPersonAgainForEachRequest) {
  Begin(WithPerson());
  brakes_ = false;
  StepWhile(kAutomated);
  inputs_.acknowledged = true;
  StepWhile(kDemand);
  StepWhile(kHandover);
  inputs_.acknowledged = false;
  StepWhile(kRecovering);
  inputs_.human_wanted = false;
  inputs_.gives_back = true;
  EXPECT_EQ(Step().state, kAutomated);
  inputs_.human_wanted = true;
  inputs_.gives_back = false;
  for (int k = 0; k < 20; ++k) EXPECT_EQ(Step().state, kDemand) << "the old answer does not count";
}

}  // namespace
}  // namespace fogline::test
