// A person who overrides the automation by the brake.
#include <gtest/gtest.h>

#include "common/errors.h"
#include "tests/unit/services/decision/take_over/asked_car.h"

namespace fogline::test {
namespace {

constexpr double kReleased_mps2 = -0.5;     // coasting_mps2
constexpr double kThreshold_mps2 = -2.5;    // with the brake at override_pedal
constexpr double kHardBraking_mps2 = -4.5;  // with the brake pressed halfway

class BrakeOverrideTest : public TakeOverTest {
 protected:
  static Scenario WithOverride() {
    Scenario scenario = WithPerson();
    scenario.person.override_by = OverrideBy::kBrake;
    scenario.person.override_pedal = 0.25;
    scenario.person.pedal_map = PedalMap::kLinear;
    scenario.person.full_brake_mps2 = 8;
    scenario.person.coasting_mps2 = 0.5;
    return scenario;
  }

  BrakeOverrideTest() {
    inputs_.human_wanted = false;
    inputs_.human_mps2 = kReleased_mps2;
  }
  void Brake(double acceleration_mps2) { inputs_.human_mps2 = acceleration_mps2; }
};

TEST_F(BrakeOverrideTest, TakesOverAtOnceWithoutARequest) {
  Begin(WithOverride());
  for (int k = 0; k < 5; ++k) EXPECT_EQ(Step().state, kAutomated);
  Brake(kHardBraking_mps2);
  const take_over::TakeOverOutcome& out = Step();
  EXPECT_EQ(out.state, kRecovering);
  EXPECT_EQ(out.acceleration_mps2, kHardBraking_mps2);
  EXPECT_TRUE(take_over_->overridden());
  EXPECT_FALSE(take_over_->request());
}

TEST_F(BrakeOverrideTest, TakesABrakeAtThePedalsThresholdAndNoLighterOne) {
  Begin(WithOverride());
  Step();
  Brake(kThreshold_mps2 + 1e-9);
  EXPECT_EQ(Step().state, kAutomated);
  Brake(kThreshold_mps2);
  EXPECT_EQ(Step().state, kRecovering);
}

// UN R157, 6.3: a driver overrides only if the driver brakes harder than the system.
TEST_F(BrakeOverrideTest, LeavesTheCarToAnAutomationThatBrakesHarder) {
  Begin(WithOverride());
  brakes_ = false;
  inputs_.automation_mps2 = -6;
  Step();
  Brake(kHardBraking_mps2);
  for (int k = 0; k < 20; ++k) EXPECT_EQ(Step().state, kAutomated);
  Brake(-6.5);
  EXPECT_EQ(Step().state, kRecovering);
}

TEST_F(BrakeOverrideTest, ListensOnlyToAPersonWhoIsThere) {
  Begin(WithOverride());
  Step();
  Brake(kHardBraking_mps2);
  inputs_.readiness = 0;
  for (int k = 0; k < 20; ++k) EXPECT_EQ(Step().state, kAutomated);
}

TEST_F(BrakeOverrideTest, HappensOnlyIfTheScenarioSaysSoAndAPersonDrives) {
  Scenario off = WithOverride();
  off.person.override_by = OverrideBy::kNone;
  Scenario modelled = WithOverride();
  modelled.person.drives = false;
  for (const Scenario& scenario : {off, modelled}) {
    Begin(scenario);
    Step();
    Brake(-8);
    for (int k = 0; k < 20; ++k) EXPECT_EQ(Step().state, kAutomated);
    Brake(kReleased_mps2);
  }
}

TEST_F(BrakeOverrideTest, LastsUntilThePersonHasRecoveredAndGivesBack) {
  Begin(WithOverride());
  brakes_ = false;
  Step();
  Brake(kHardBraking_mps2);
  Step();
  const double taken_s = Now();
  Brake(kReleased_mps2);
  inputs_.gives_back = true;
  EXPECT_NEAR(StepWhile(kRecovering), taken_s + 5, 1e-9);
  inputs_.gives_back = false;
  for (int k = 0; k < 100; ++k) EXPECT_EQ(Step().state, kManual);
  EXPECT_TRUE(take_over_->overridden());
  inputs_.gives_back = true;
  EXPECT_EQ(Step().state, kAutomated);
  EXPECT_FALSE(take_over_->overridden());
}

TEST_F(BrakeOverrideTest, AnswersARequestThatIsPendingWhateverAnswersARequestOtherwise) {
  Begin(WithOverride());
  inputs_.human_wanted = true;
  EXPECT_EQ(Step().state, kDemand);
  StepWhile(kDemand);
  ASSERT_EQ(state(), kUrgentDemand);
  Brake(kHardBraking_mps2);
  EXPECT_EQ(Step().state, kRecovering) << "acknowledged is false: take_over_by may be button";
  EXPECT_EQ(take_over_->request()->requested, 0);
  EXPECT_EQ(take_over_->request()->acknowledged, step_ - 1);
  EXPECT_EQ(take_over_->request()->transferred, step_ - 1);
}

TEST_F(BrakeOverrideTest, EndsAManoeuvreWhileTheCarMovesAndNotWhenItStands) {
  Begin(WithOverride());
  inputs_.human_wanted = true;
  while (state() != kMrmComfort) Step();
  for (int k = 0; k < 10; ++k) Step();
  Brake(kHardBraking_mps2);
  EXPECT_EQ(Step().state, kRecovering);
  Begin(WithOverride());
  Brake(kReleased_mps2);
  inputs_.speed_mps = 5;
  inputs_.applied_mps2 = 0;
  step_ = 0;
  while (state() != kMrmDone) Step();
  Brake(-8);
  for (int k = 0; k < 20; ++k) EXPECT_EQ(Step().state, kMrmDone);
}

TEST_F(BrakeOverrideTest, LeavesNoRequestBehindFromBefore) {
  Begin(WithOverride());
  brakes_ = false;
  inputs_.human_wanted = true;
  Step();
  inputs_.acknowledged = true;
  StepWhile(kDemand);
  StepWhile(kHandover);
  StepWhile(kRecovering);
  inputs_.acknowledged = inputs_.human_wanted = false;
  inputs_.gives_back = true;
  EXPECT_EQ(Step().state, kAutomated);
  inputs_.gives_back = false;
  ASSERT_TRUE(take_over_->request());
  Brake(kHardBraking_mps2);
  EXPECT_EQ(Step().state, kRecovering);
  EXPECT_FALSE(take_over_->request());
}

TEST_F(BrakeOverrideTest, IsRefusedIfReleasedPedalsAlreadyBrakeAsHard) {
  Scenario scenario = WithOverride();
  scenario.person.full_brake_mps2 = 1;
  scenario.person.coasting_mps2 = 3;
  try {
    Begin(scenario);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "/person/override_pedal: a brake at 0.25 brakes no harder than the released "
                 "pedals: /person/full_brake_mps2 is 1, and /person/coasting_mps2 is 3");
  }
  scenario.person.override_by = OverrideBy::kNone;
  EXPECT_NO_THROW(Begin(scenario));
}

}  // namespace
}  // namespace fogline::test
