#include "services/arbitrator/failsafe_arbitrator.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/unit/services/arbitrator/failsafe_inputs.h"
#include "tests/unit/services/arbitrator/two_commands.h"

namespace fogline {
namespace {

constexpr double kApplied_mps2 = 0.3;

Scenario SomeScenario() {
  Scenario scenario;
  scenario.arbitrator.window_steps = 1;
  scenario.minimal_risk = {.deceleration_mps2 = 3, .jerk_mps3 = 2};
  return scenario;
}

// The arbitrator and a set of input messages that a test can change.
class FailsafeArbitratorTest : public test::FailsafeInputsTest {
 protected:
  FailsafeArbitratorTest() {
    radar_.valid = lidar_.valid = 1;
    radar_.range_m = lidar_.range_m = 32;
    ego_.speed_mps = 20;
    ego_.acceleration_mps2 = kApplied_mps2;
    automation_.acceleration_mps2 = kAutomation_mps2;
    driver_.acceleration_mps2 = kHuman_mps2;
    SetAll(InputState::kOk);
  }

  void SetAll(InputState state) {
    Set(inputs_.ego, state, ego_);
    Set(inputs_.radar, state, radar_);
    Set(inputs_.lidar, state, lidar_);
    Set(inputs_.track, state, track_);
    Set(inputs_.automation, state, automation_);
    Set(inputs_.driver, state, driver_);
  }
  template <class M>
  static void Set(Heard<M>& input, InputState state, const M& message) {
    input = {.state = state, .newest = state == InputState::kAwaited ? nullptr : &message};
  }
  void Disagree() { radar_.range_m = lidar_.range_m + 5; }

  // Takes the next step. Each sensor whose state is OK has a value of this step.
  const arbitration_t& Step() {
    const header_t header{.run_id = 7, .step = step_, .utime = step_ * 100'000};
    ++step_;
    if (inputs_.radar.state == InputState::kOk) radar_.header = header;
    if (inputs_.lidar.state == InputState::kOk) lidar_.header = header;
    return arbitrator_.Step(header, inputs_);
  }
  void ExpectAutomation(const arbitration_t& out) {
    EXPECT_EQ(out.mode, arbitration_t::AUTOMATION);
    EXPECT_EQ(out.lambda_automation, 1);
    EXPECT_EQ(out.lambda_human, 0);
    EXPECT_EQ(out.acceleration_mps2, kAutomation_mps2);
  }
  void ExpectHuman(const arbitration_t& out) {
    EXPECT_EQ(out.mode, arbitration_t::HUMAN);
    EXPECT_EQ(out.lambda_automation, 0);
    EXPECT_EQ(out.lambda_human, 1);
    EXPECT_EQ(out.acceleration_mps2, kHuman_mps2);
  }
  void ExpectMinimalRisk(const arbitration_t& out, double acceleration_mps2) {
    EXPECT_EQ(out.mode, arbitration_t::MINIMAL_RISK);
    EXPECT_EQ(out.lambda_automation, 0);
    EXPECT_EQ(out.lambda_human, 0);
    EXPECT_NEAR(out.acceleration_mps2, acceleration_mps2, 1e-12);
  }

  arbitrator::FailsafeArbitrator arbitrator_{SomeScenario()};
};

// The input state that causes this offer.
InputState StateOf(arbitrator::Offer offer) {
  return offer == arbitrator::kThere    ? InputState::kOk
         : offer == arbitrator::kNotYet ? InputState::kAwaited
                                        : InputState::kLost;
}

// The decision must equal the row's decision for every combination of inputs that the row covers.
TEST_F(FailsafeArbitratorTest, DoesWhatEachRowOfTheTableSays) {
  int cases = 0;
  for (const arbitrator::FailsafeRow& row : arbitrator::kFailsafeTable) {
    for (const arbitrator::Offer automation :
         {arbitrator::kThere, arbitrator::kNotYet, arbitrator::kGone}) {
      for (const arbitrator::Offer human :
           {arbitrator::kThere, arbitrator::kNotYet, arbitrator::kGone}) {
        for (const arbitrator::Conflict conflict : {arbitrator::kCalm, arbitrator::kDisputed}) {
          if (!arbitrator::Applies(row, automation, human, conflict)) continue;
          ++cases;
          SCOPED_TRACE("case " + std::to_string(cases));
          arbitrator_ = arbitrator::FailsafeArbitrator(SomeScenario());
          SetAll(InputState::kOk);
          radar_.range_m = lidar_.range_m + (conflict == arbitrator::kDisputed ? 5 : 0);
          Set(inputs_.automation, StateOf(automation), automation_);
          Set(inputs_.driver, StateOf(human), driver_);
          const arbitration_t& out = Step();
          EXPECT_EQ(arbitrator_.decision(), row.decision);
          switch (row.decision) {
            case arbitrator::Decision::kRegular:
              conflict == arbitrator::kDisputed ? ExpectHuman(out) : ExpectAutomation(out);
              break;
            case arbitrator::Decision::kAutomation:
              ExpectAutomation(out);
              break;
            case arbitrator::Decision::kHuman:
              ExpectHuman(out);
              break;
            case arbitrator::Decision::kHold:
              EXPECT_EQ(out.acceleration_mps2, kApplied_mps2);
              break;
            case arbitrator::Decision::kMinimalRisk:
              ExpectMinimalRisk(out, kApplied_mps2 - 0.2);
              break;
          }
        }
      }
    }
  }
  EXPECT_EQ(cases, 3 * 3 * 2);
}

TEST_F(FailsafeArbitratorTest, CopiesTheHeaderOfItsStep) {
  Step();
  const arbitration_t& out = Step();
  EXPECT_EQ(out.header.run_id, 7);
  EXPECT_EQ(out.header.step, 1);
  EXPECT_EQ(out.header.utime, 100'000);
}

TEST_F(FailsafeArbitratorTest, CallsTheHumanForEachInputThatTheAutomationNeeds) {
  for (InputState* state : {&inputs_.radar.state, &inputs_.lidar.state, &inputs_.track.state,
                            &inputs_.automation.state}) {
    SetAll(InputState::kOk);
    ExpectAutomation(Step());
    *state = InputState::kLost;
    ExpectHuman(Step());
  }
}

TEST_F(FailsafeArbitratorTest, CallsTheHumanWhereTheSensorsComeInTimeButNeverOfTheSameStep) {
  ExpectAutomation(Step());
  lidar_.header.step = -10;
  inputs_.lidar.state = InputState::kStale;  // Step() then does not set the header of this message
  for (int k = 0; k < 5; ++k) Step();
  inputs_.radar.state = InputState::kOk;
  ExpectHuman(Step());
}

TEST_F(FailsafeArbitratorTest, HoldsTheLastOffersWhileTheyAreStale) {
  SetAll(InputState::kStale);
  ExpectAutomation(Step());
  Disagree();
  radar_.header.step = lidar_.header.step = 1;
  ExpectHuman(Step());
}

TEST_F(FailsafeArbitratorTest, TakesNoConflictFromValuesOfDifferentSteps) {
  ExpectAutomation(Step());
  // GIVEN sensors that differ by 5 m, without a LiDAR value of this step
  inputs_.lidar.state = InputState::kStale;
  Disagree();
  // THEN the last conflict stays until radar and LiDAR have values of the same step
  const arbitration_t& held = Step();
  EXPECT_EQ(held.conflict_m, 0);
  ExpectAutomation(held);
  inputs_.lidar.state = InputState::kOk;
  ExpectHuman(Step());
}

TEST_F(FailsafeArbitratorTest, CountsThePairOfAStepOnce) {
  Scenario scenario = SomeScenario();
  scenario.arbitrator.window_steps = 4;
  arbitrator_ = arbitrator::FailsafeArbitrator(scenario);
  // GIVEN differences of 0, 0 and 2 m
  Step();
  Step();
  radar_.range_m = lidar_.range_m + 2;
  const double conflict_m = Step().conflict_m;
  EXPECT_NEAR(conflict_m, 2.0 / 3, 1e-12);
  // WHEN no new LiDAR value comes
  inputs_.lidar.state = InputState::kStale;
  // THEN the last difference does not get more weight
  for (int k = 0; k < 3; ++k) EXPECT_EQ(Step().conflict_m, conflict_m);
  // AND the next pair counts normally
  inputs_.lidar.state = InputState::kOk;
  radar_.range_m = lidar_.range_m;
  EXPECT_NEAR(Step().conflict_m, 2.0 / 4, 1e-12);
}

TEST_F(FailsafeArbitratorTest, StopsWhenTheHumanIsLostAndTheConflictAsksForHim) {
  inputs_.driver.state = InputState::kLost;
  ExpectAutomation(Step());
  Disagree();
  ExpectMinimalRisk(Step(), kApplied_mps2 - 0.2);
}

TEST_F(FailsafeArbitratorTest, NeverLeavesTheMinimalRiskManoeuvre) {
  SetAll(InputState::kLost);
  inputs_.ego.state = InputState::kOk;
  ExpectMinimalRisk(Step(), kApplied_mps2 - 0.2);
  SetAll(InputState::kOk);
  ExpectMinimalRisk(Step(), kApplied_mps2 - 0.4);
  ego_.speed_mps = 0;
  for (int k = 0; k < 100; ++k) Step();
  ExpectMinimalRisk(Step(), 0);
}

TEST_F(FailsafeArbitratorTest, StopsOnDemand) {
  ExpectAutomation(Step());
  arbitrator_.DemandMinimalRisk();
  ExpectMinimalRisk(Step(), kApplied_mps2 - 0.2);
  EXPECT_EQ(arbitrator_.decision(), arbitrator::Decision::kMinimalRisk);
}

TEST_F(FailsafeArbitratorTest, HandsBackOnceTheAutomationIsThereAgain) {
  inputs_.automation.state = InputState::kLost;
  ExpectHuman(Step());
  EXPECT_EQ(arbitrator::FallbackText(arbitrator_.decision()), "the human drives");
  inputs_.automation.state = InputState::kOk;
  ExpectAutomation(Step());
  EXPECT_EQ(arbitrator::FallbackText(arbitrator_.decision()), "");
}

Scenario Guarded() {
  Scenario scenario = SomeScenario();
  scenario.aeb.enabled = true;
  return scenario;
}

class GuardedFailsafeTest : public FailsafeArbitratorTest {
 protected:
  GuardedFailsafeTest() {
    arbitrator_ = arbitrator::FailsafeArbitrator(Guarded());
    track_.valid = 1;
    track_.state[0] = 10;
    track_.state[1] = -10;
  }
  void ExpectEmergencyBraking(const arbitration_t& out) {
    EXPECT_EQ(out.mode, arbitration_t::EMERGENCY_BRAKING);
    EXPECT_EQ(out.acceleration_mps2, -9);
  }
};

TEST_F(GuardedFailsafeTest, BrakesInEveryDecisionThatHasATrack) {
  ExpectEmergencyBraking(Step());
  Set(inputs_.automation, InputState::kLost, automation_);
  ExpectEmergencyBraking(Step());
  EXPECT_EQ(arbitrator_.decision(), arbitrator::Decision::kHuman);
  Set(inputs_.automation, InputState::kOk, automation_);
  Set(inputs_.driver, InputState::kLost, driver_);
  ExpectEmergencyBraking(Step());
  EXPECT_EQ(arbitrator_.decision(), arbitrator::Decision::kAutomation);
  Set(inputs_.track, InputState::kStale, track_);
  ExpectEmergencyBraking(Step());
}

TEST_F(GuardedFailsafeTest, BrakesForNoTrackThatIsLost) {
  Step();
  Set(inputs_.track, InputState::kLost, track_);
  ExpectHuman(Step());
}

TEST_F(GuardedFailsafeTest, BrakesInTheMinimalRiskManoeuvreUnderItsMode) {
  Set(inputs_.automation, InputState::kLost, automation_);
  Set(inputs_.driver, InputState::kLost, driver_);
  ExpectMinimalRisk(Step(), -9);
  track_.state[1] = 1;
  ExpectMinimalRisk(Step(), kApplied_mps2 - 0.4);
}

// In decision kHold the last command of the side that drives is repeated, and not the command of
// emergency braking.
TEST_F(GuardedFailsafeTest, HoldsTheCommandBeforeTheBraking) {
  ExpectEmergencyBraking(Step());
  track_.state[1] = 1;
  Disagree();
  Set(inputs_.driver, InputState::kAwaited, driver_);
  const arbitration_t& out = Step();
  EXPECT_EQ(arbitrator_.decision(), arbitrator::Decision::kHold);
  EXPECT_EQ(out.acceleration_mps2, kAutomation_mps2);
  EXPECT_EQ(out.mode, arbitration_t::AUTOMATION);
}

TEST_F(GuardedFailsafeTest, EqualsTheArbitratorInLockstepIfAllInputsAreThere) {
  arbitrator::Arbitrator lockstep(Guarded());
  for (int k = 0; k < 60; ++k) {
    track_.state[0] = 30 - 0.5 * k;
    track_.state[1] = k < 45 ? -10 : 0.5;
    radar_.range_m = lidar_.range_m + (k % 20 < 10 ? 0 : 2);
    const arbitration_t out = Step();
    const arbitration_t& same = lockstep.Step(ego_, radar_, lidar_, track_, automation_, driver_);
    EXPECT_EQ(out.mode, same.mode) << k;
    EXPECT_EQ(out.acceleration_mps2, same.acceleration_mps2) << k;
    EXPECT_EQ(out.lambda_human, same.lambda_human) << k;
  }
}

}  // namespace
}  // namespace fogline
