// A person who overrides the automation, or leaves the seat and comes back, in real time.
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "common/errors.h"
#include "tests/support/find_row.h"
#include "tests/unit/services/arbitrator/failsafe_take_over.h"

namespace fogline::test {
namespace {

/// A scenario with a person as the driver, who may leave the seat and come back.
Scenario ComingBack() {
  Scenario scenario = FailsafeTakeOverTest::AskingAPerson();
  scenario.person.when_gone = WhenGone::kUntilBack;
  return scenario;
}

class FailsafeReturnTest : public FailsafeTakeOverTest {
 protected:
  FailsafeReturnTest() : FailsafeTakeOverTest(ComingBack()) {}
  void SetUp() override {
    StepUntil(arbitration_t::REQUEST);
    driver_.acknowledged = 1;
    StepUntil(arbitration_t::RECOVERING);
    driver_.acknowledged = 0;
  }
  void Leave() { driver_.readiness = 0; }
  void ComeBack() { driver_.readiness = 1; }
};

TEST_F(FailsafeReturnTest, StopsWithoutThePersonAndGoesOnWithAnAnswerOfThePerson) {
  Leave();
  EXPECT_EQ(Step().mode, arbitration_t::MRM_COMFORT);
  EXPECT_EQ(last_.lambda_human, 0);
  EXPECT_NEAR(last_.acceleration_mps2, -0.4 - 0.25, 1e-12) << "2.5 m/s3 from the person's command";
  EXPECT_EQ(arbitrator_.minimal_risk(), 0);
  for (int k = 0; k < 20; ++k) ASSERT_EQ(Step().mode, arbitration_t::MRM_COMFORT);
  ComeBack();
  for (int k = 0; k < 20; ++k) {
    ASSERT_EQ(Step().mode, arbitration_t::MRM_COMFORT) << "a person who only sits there";
  }
  driver_.acknowledged = 1;
  EXPECT_EQ(Step().mode, arbitration_t::RECOVERING);
  EXPECT_EQ(last_.lambda_human, 1);
  EXPECT_EQ(last_.acceleration_mps2, -0.4);
}

TEST_F(FailsafeReturnTest, StopsSmoothlyEachTimeAndNeverReturnsToTheAutomation) {
  for (int time = 0; time < 3; ++time) {
    for (int k = 0; k < 30; ++k) ASSERT_EQ(Step().lambda_human, 1);
    Leave();
    EXPECT_EQ(Step().mode, arbitration_t::MRM_COMFORT);
    EXPECT_NEAR(last_.acceleration_mps2, -0.4 - 0.25, 1e-12);
    for (int k = 0; k < 10; ++k) Step();
    ComeBack();
    driver_.acknowledged = 1;
    EXPECT_EQ(Step().mode, arbitration_t::RECOVERING);
    driver_.acknowledged = 0;
  }
  Agree();
  driver_.gives_back = 1;
  for (int k = 0; k < 100; ++k) ASSERT_EQ(Step().lambda_human, 1);
}

TEST_F(FailsafeReturnTest, LocksTheCarThatStands) {
  Leave();
  Step();
  ego_.speed_mps = 0;
  StepUntil(arbitration_t::MRM_DONE);
  ComeBack();
  driver_.acknowledged = 1;
  for (int k = 0; k < 20; ++k) ASSERT_EQ(Step().mode, arbitration_t::MRM_DONE);
}

TEST_F(FailsafeReturnTest, StopsAlsoWhenTheDriversMessagesAreLost) {
  inputs_.driver.state = InputState::kLost;
  EXPECT_EQ(Step().mode, arbitration_t::MRM_COMFORT);
  inputs_.driver.state = InputState::kOk;
  driver_.acknowledged = 1;
  EXPECT_EQ(Step().mode, arbitration_t::RECOVERING);
}

/// A scenario with a person as the driver, who may override by the brake. A transfer without an
/// override takes 5 s.
Scenario Overriding(std::string_view policy = "traded") {
  Scenario scenario = FailsafeTakeOverTest::AskingAPerson();
  scenario.arbitrator.policy = FindPolicy(policy).value();
  scenario.arbitrator.transfer.profile = TransferProfile::kLinear;
  scenario.arbitrator.transfer.duration_s = 5;
  scenario.person.override_by = OverrideBy::kBrake;
  return scenario;
}

class FailsafeOverrideTest : public FailsafeTakeOverTest {
 protected:
  explicit FailsafeOverrideTest(const Scenario& scenario = Overriding())
      : FailsafeTakeOverTest(scenario) {
    Agree();
    driver_.acceleration_mps2 = kReleased_mps2;
  }
  void Brake() { driver_.acceleration_mps2 = kBraking_mps2; }

  static constexpr double kReleased_mps2 = -0.5;
  static constexpr double kBraking_mps2 = -5;
};

TEST_F(FailsafeOverrideTest, TakesTheWholeAuthorityAtOnceWhateverTheProfile) {
  for (int k = 0; k < 10; ++k) ASSERT_EQ(Step().mode, arbitration_t::AUTOMATION);
  Brake();
  EXPECT_EQ(Step().mode, arbitration_t::RECOVERING);
  EXPECT_EQ(last_.lambda_human, 1);
  EXPECT_EQ(last_.acceleration_mps2, kBraking_mps2);
  driver_.acceleration_mps2 = kReleased_mps2;
  for (int k = 0; k < 100; ++k) {
    ASSERT_EQ(Step().lambda_human, 1) << "until the person gives back";
    ASSERT_EQ(last_.acceleration_mps2, kReleased_mps2);
  }
  driver_.gives_back = 1;
  EXPECT_EQ(Step().mode, arbitration_t::AUTOMATION);
}

TEST_F(FailsafeOverrideTest, HappensAlsoInTheFirstStep) {
  Brake();
  EXPECT_EQ(Step().mode, arbitration_t::RECOVERING);
  EXPECT_EQ(last_.acceleration_mps2, kBraking_mps2);
}

TEST_F(FailsafeOverrideTest, IsNothingThatAnEmptySeatCouldDo) {
  Step();
  Brake();
  driver_.readiness = 0;
  for (int k = 0; k < 20; ++k) ASSERT_EQ(Step().mode, arbitration_t::AUTOMATION);
}

TEST_F(FailsafeOverrideTest, KeepsNoAuthorityWhenThePersonHasGone) {
  Step();
  Brake();
  Step();
  driver_.readiness = 0;
  EXPECT_EQ(Step().mode, arbitration_t::MINIMAL_RISK);
}

TEST_F(FailsafeOverrideTest, LetsThePersonDriveWhenTheAutomationIsLostInTheSameStep) {
  Step();
  Brake();
  inputs_.automation.state = InputState::kLost;
  EXPECT_EQ(Step().mode, arbitration_t::HUMAN);
  EXPECT_EQ(last_.acceleration_mps2, kBraking_mps2);
}

class FailsafeSharedOverrideTest : public FailsafeOverrideTest {
 protected:
  FailsafeSharedOverrideTest() : FailsafeOverrideTest(Overriding("blend")) {}
};

TEST_F(FailsafeSharedOverrideTest, LeavesTheAutomationNoShare) {
  Step();
  Brake();
  for (int k = 0; k < 20; ++k) {
    ASSERT_EQ(Step().lambda_human, 1);
    ASSERT_EQ(last_.acceleration_mps2, kBraking_mps2);
  }
}

/// The error text for this scenario if take_over.mode is kInstant. In this mode the car need not
/// ask the driver.
std::string ErrorIfInstant(Scenario scenario) {
  scenario.arbitrator.take_over.mode = TakeOverMode::kInstant;
  try {
    const arbitrator::FailsafeArbitrator arbitrator(scenario);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ChoicesOfAPersonTest, ThatAskForAnAnswerNeedADriverWhoIsAsked) {
  EXPECT_EQ(ErrorIfInstant(FailsafeTakeOverTest::AskingAPerson()), "");
  EXPECT_EQ(ErrorIfInstant(Overriding()),
            "/person/override_by: \"brake\" needs /arbitrator/take_over/mode \"requested\"");
  EXPECT_EQ(ErrorIfInstant(ComingBack()),
            "/person/when_gone: \"until_back\" needs /arbitrator/take_over/mode \"requested\"");
}

}  // namespace
}  // namespace fogline::test
