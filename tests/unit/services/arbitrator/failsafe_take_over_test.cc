// The fallback for a driver whom the car must ask to take over, in real time. Inputs may fail, too.
#include <cstdint>
#include <string_view>

#include <gtest/gtest.h>

#include "common/errors.h"
#include "services/arbitrator/failsafe_arbitrator.h"
#include "tests/support/find_row.h"

namespace fogline {
namespace {

Scenario Asking() {
  Scenario scenario;
  scenario.arbitrator.window_steps = 1;
  scenario.arbitrator.take_over = {.mode = TakeOverMode::kRequested,
                                   .lead_s = 10,
                                   .escalation_s = 1,
                                   .time = {.mean_s = 2, .std_s = 1e-3},
                                   .recovery_s = 1};
  return scenario;
}

/// The driver is a person.
Scenario AskingAPerson() {
  Scenario scenario = Asking();
  scenario.person.drives = true;
  return scenario;
}

class FailsafeTakeOverTest : public testing::Test {
 protected:
  explicit FailsafeTakeOverTest(const Scenario& scenario = Asking()) : arbitrator_(scenario) {
    radar_.valid = lidar_.valid = 1;
    radar_.range_m = 37;
    lidar_.range_m = 32;  // radar and LiDAR disagree
    ego_.speed_mps = 20;
    automation_.acceleration_mps2 = 0.2;
    driver_.acceleration_mps2 = -0.4;
    driver_.readiness = 1;
    inputs_ = {.ego = {InputState::kOk, &ego_},
               .radar = {InputState::kOk, &radar_},
               .lidar = {InputState::kOk, &lidar_},
               .track = {InputState::kOk, &track_},
               .automation = {InputState::kOk, &automation_},
               .driver = {InputState::kOk, &driver_}};
  }

  const arbitration_t& Step() {
    const header_t header{.run_id = 7, .step = step_, .utime = step_ * 100'000};
    ++step_;
    ego_.header = radar_.header = lidar_.header = header;
    return last_ = arbitrator_.Step(header, inputs_);
  }
  /// Makes steps until the mode is reached, for at most a minute.
  void StepUntil(std::int8_t mode) {
    for (int k = 0; k < 600 && Step().mode != mode; ++k) {
    }
    ASSERT_EQ(last_.mode, mode);
  }
  void Agree() { radar_.range_m = lidar_.range_m; }

  arbitrator::FailsafeArbitrator arbitrator_;
  ego_t ego_{};
  radar_t radar_{};
  lidar_t lidar_{};
  track_t track_{};
  accel_command_t automation_{};
  driver_command_t driver_{};
  arbitrator::ArbitratorInputs inputs_;
  arbitration_t last_{};
  std::int64_t step_ = 0;
};

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

/// A person who overrides by the brake. The authority otherwise changes within 5 s.
Scenario Overriding(std::string_view policy = "traded") {
  Scenario scenario = AskingAPerson();
  scenario.arbitrator.policy = test::FindPolicy(policy).value();
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

TEST(OverrideScenarioTest, NeedsADriverWhoIsAsked) {
  Scenario scenario = Overriding();
  scenario.arbitrator.take_over.mode = TakeOverMode::kInstant;
  try {
    const arbitrator::FailsafeArbitrator arbitrator(scenario);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "/person/override_by: \"brake\" needs /arbitrator/take_over/mode "
                 "\"requested\": only then can the person give back");
  }
}

/// A person who need not be asked.
Scenario InstantPerson() {
  Scenario scenario = AskingAPerson();
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
}  // namespace fogline
