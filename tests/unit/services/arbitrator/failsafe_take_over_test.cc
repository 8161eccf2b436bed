// The fallback for a driver whom the car must ask to take over, in real time. Inputs may fail, too.
#include <gtest/gtest.h>

#include "tests/unit/services/arbitrator/failsafe_take_over.h"

namespace fogline::test {
namespace {

TEST_F(FailsafeTakeOverTest, AsksHandsOverAndReturnsWhileEverythingIsThere) {
  EXPECT_EQ(Step().mode, arbitration_t::REQUEST);
  StepUntil(arbitration_t::HANDOVER);
  StepUntil(arbitration_t::RECOVERING);
  EXPECT_EQ(last_.acceleration_mps2, -0.4);
  EXPECT_EQ(last_.lambda_human, 1);
  Agree();
  StepUntil(arbitration_t::AUTOMATION);
  EXPECT_EQ(last_.acceleration_mps2, 0.2);
  EXPECT_EQ(arbitrator_.minimal_risk(), 0);
}

TEST_F(FailsafeTakeOverTest, StopsForADriverWhoseCommandIsLostWhileHeIsAsked) {
  Step();
  inputs_.driver.state = InputState::kLost;  // the driver's newest message still reports readiness
  StepUntil(arbitration_t::MRM_COMFORT);
  EXPECT_EQ(step_ - 1, 100) << "10 s after the request";
  EXPECT_EQ(last_.lambda_automation + last_.lambda_human, 0);
  EXPECT_EQ(arbitrator_.minimal_risk(), 0) << "the driver may still come";
}

TEST_F(FailsafeTakeOverTest, GoesOnStoppingWhateverElseIsLost) {
  Step();
  inputs_.driver.state = InputState::kLost;
  StepUntil(arbitration_t::MRM_COMFORT);
  inputs_.automation.state = inputs_.track.state = inputs_.radar.state = InputState::kLost;
  const double before_mps2 = last_.acceleration_mps2;
  EXPECT_EQ(Step().mode, arbitration_t::MRM_COMFORT);
  EXPECT_NEAR(last_.acceleration_mps2, before_mps2 - 0.25, 1e-12);
  ego_.speed_mps = 0;
  StepUntil(arbitration_t::MRM_DONE);
  EXPECT_NE(arbitrator_.minimal_risk(), 0);
  inputs_.driver.state = inputs_.automation.state = InputState::kOk;
  arbitrator_.DemandMinimalRisk();
  for (int k = 0; k < 100; ++k) ASSERT_EQ(Step().mode, arbitration_t::MRM_DONE);
}

TEST_F(FailsafeTakeOverTest, StopsAtOnceWhenTheAutomationIsLostBeforeARequest) {
  Agree();
  EXPECT_EQ(Step().mode, arbitration_t::AUTOMATION);
  inputs_.automation.state = InputState::kLost;
  EXPECT_EQ(Step().mode, arbitration_t::MINIMAL_RISK);
  EXPECT_NE(arbitrator_.minimal_risk(), 0);
}

TEST_F(FailsafeTakeOverTest, LeavesTheWheelToADriverWhoHasItWhenTheAutomationIsLost) {
  StepUntil(arbitration_t::RECOVERING);
  inputs_.automation.state = InputState::kLost;
  Agree();
  for (int k = 0; k < 100; ++k) {
    ASSERT_EQ(Step().lambda_human, 1);
    ASSERT_EQ(last_.acceleration_mps2, -0.4);
  }
  inputs_.automation.state = InputState::kOk;
  StepUntil(arbitration_t::AUTOMATION);
}

TEST_F(FailsafeTakeOverTest, StopsAtOnceWhenTheDriverWhoHasTheWheelIsLostAndIsWanted) {
  StepUntil(arbitration_t::RECOVERING);
  inputs_.driver.state = InputState::kLost;
  EXPECT_EQ(Step().mode, arbitration_t::MINIMAL_RISK);
}

TEST_F(FailsafeTakeOverTest, LetsALateDriverEndTheManoeuvre) {
  driver_.readiness = 0;
  Step();
  StepUntil(arbitration_t::MRM_COMFORT);
  for (int k = 0; k < 10; ++k) Step();
  driver_.readiness = 1;
  EXPECT_EQ(Step().mode, arbitration_t::RECOVERING);
  EXPECT_EQ(last_.acceleration_mps2, -0.4);
  EXPECT_EQ(arbitrator_.minimal_risk(), 0);
}

TEST_F(FailsafeTakeOverTest, LetsALateDriverEndTheManoeuvreAlsoIfTheAutomationIsLost) {
  driver_.readiness = 0;
  Step();
  StepUntil(arbitration_t::MRM_COMFORT);
  inputs_.automation.state = InputState::kLost;
  for (int k = 0; k < 10; ++k) Step();
  driver_.readiness = 1;
  // HUMAN does not end the manoeuvre of the vehicle. RECOVERING lasts for several steps, so a lost
  // command does not matter.
  for (int k = 0; k < 5; ++k) {
    ASSERT_EQ(Step().mode, arbitration_t::RECOVERING);
    EXPECT_EQ(last_.acceleration_mps2, -0.4);
    EXPECT_EQ(last_.lambda_human, 1);
  }
  StepUntil(arbitration_t::HUMAN);
  EXPECT_EQ(arbitrator_.minimal_risk(), 0);
}

TEST_F(FailsafeTakeOverTest, GivesNoAuthorityToADriverWhoWasNotAskedWhileTheAutomationIsAwaited) {
  Agree();
  inputs_.automation = {InputState::kAwaited, nullptr};
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(Step().mode, arbitration_t::AUTOMATION);
    EXPECT_EQ(last_.lambda_human, 0);
  }
}

/// A person drives. The driver's process sends its messages also when no person is there; the
/// readiness is then 0.
class FailsafePersonTest : public FailsafeTakeOverTest {
 protected:
  FailsafePersonTest() : FailsafeTakeOverTest(AskingAPerson()) {}

  void TakeOver() {
    StepUntil(arbitration_t::REQUEST);
    driver_.acknowledged = 1;
    StepUntil(arbitration_t::RECOVERING);
    driver_.acknowledged = 0;
  }
  void Leave() {
    driver_.readiness = 0;
    driver_.acceleration_mps2 = -0.5;
  }
};

TEST_F(FailsafePersonTest, TakesOverWhenHeAnswersAndNotBefore) {
  EXPECT_EQ(Step().mode, arbitration_t::REQUEST);
  for (int k = 0; k < 50; ++k) Step();
  EXPECT_EQ(last_.mode, arbitration_t::REQUEST_URGENT);
  EXPECT_EQ(last_.lambda_human, 0);
  driver_.acknowledged = 1;
  EXPECT_EQ(Step().mode, arbitration_t::HANDOVER);
  EXPECT_EQ(Step().mode, arbitration_t::RECOVERING);
  EXPECT_EQ(last_.acceleration_mps2, -0.4);
}

TEST_F(FailsafePersonTest, KeepsNoAuthorityWhenHeHasGone) {
  TakeOver();
  EXPECT_EQ(last_.lambda_human, 1);
  Leave();
  EXPECT_EQ(Step().mode, arbitration_t::MINIMAL_RISK);
  EXPECT_EQ(last_.lambda_human, 0);
}

TEST_F(FailsafePersonTest, LetsTheAutomationDriveWhileTheSeatIsEmptyAndNoPersonIsWanted) {
  Agree();
  Leave();
  for (int k = 0; k < 100; ++k) {
    ASSERT_EQ(Step().mode, arbitration_t::AUTOMATION);
    ASSERT_EQ(last_.acceleration_mps2, 0.2);
  }
  EXPECT_NE(arbitrator_.fallback(), "");
}

TEST_F(FailsafePersonTest, IsAskedAlsoWhenTheSeatIsEmptyAndThenTheCarStops) {
  Leave();
  EXPECT_EQ(Step().mode, arbitration_t::REQUEST);
  StepUntil(arbitration_t::MRM_COMFORT);
  EXPECT_EQ(step_ - 1, 100) << "10 s after the request";
  EXPECT_EQ(last_.lambda_human, 0);
}

TEST_F(FailsafePersonTest, StopsWhenTheAutomationIsLostAndTheSeatIsEmpty) {
  TakeOver();
  Leave();
  inputs_.automation.state = InputState::kLost;
  EXPECT_EQ(Step().mode, arbitration_t::MINIMAL_RISK);
}

/// A scenario with a person as the driver, whom the car need not ask.
Scenario InstantPerson() {
  Scenario scenario = FailsafeTakeOverTest::AskingAPerson();
  scenario.arbitrator.take_over.mode = TakeOverMode::kInstant;
  return scenario;
}

class FailsafeFirstInputTest : public FailsafeTakeOverTest {
 protected:
  FailsafeFirstInputTest() : FailsafeTakeOverTest(InstantPerson()) { driver_.readiness = 0; }
};

TEST_F(FailsafeFirstInputTest, IsAwaitedAtTheStartOfTheRun) {
  EXPECT_EQ(Step().mode, arbitration_t::AUTOMATION) << "the first command holds";
  EXPECT_EQ(Step().mode, arbitration_t::AUTOMATION);
  driver_.readiness = 1;
  EXPECT_EQ(Step().mode, arbitration_t::HUMAN);
  driver_.readiness = 0;
  EXPECT_EQ(Step().mode, arbitration_t::MINIMAL_RISK) << "the person was there, and has gone";
}

TEST_F(FailsafeFirstInputTest, IsNotAwaitedLongerThanTheDeadmansTime) {
  for (int k = 0; k < 3; ++k) EXPECT_EQ(Step().mode, arbitration_t::AUTOMATION) << k;
  EXPECT_EQ(Step().mode, arbitration_t::MINIMAL_RISK) << "0.3 s";
}

}  // namespace
}  // namespace fogline::test
