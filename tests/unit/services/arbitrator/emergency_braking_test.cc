// Emergency braking by the arbitrator: while either side drives, during a minimal risk manoeuvre,
// and while the arbitrator asks the driver to take over.
#include <cstdint>

#include <gtest/gtest.h>

#include "services/arbitrator/arbitrator.h"
#include "services/host_modes.h"
#include "tests/unit/services/arbitrator/step_messages.h"

namespace fogline {
namespace {

class GuardedTest : public testing::Test {
 protected:
  static Scenario Guarded() {
    Scenario scenario;
    scenario.arbitrator.window_steps = 1;
    scenario.aeb.enabled = true;
    return scenario;
  }
  /// A step in which the track has the car ahead at this distance and closing speed.
  const arbitration_t& StepAt(double distance_m, double closing_mps, Messages m = Differing(0)) {
    m.ego.speed_mps = 20;
    m.track.valid = 1;
    m.track.state[0] = distance_m;
    m.track.state[1] = -closing_mps;
    m.driver.readiness = 1;
    m.ego.header.step = m.radar.header.step = m.lidar.header.step = m.track.header.step = step_++;
    return Step(arbitrator_, m);
  }

  arbitrator::Arbitrator arbitrator_{Guarded()};
  std::int64_t step_ = 0;
};

TEST_F(GuardedTest, BrakesWhicheverSideDrives) {
  for (const bool human : {false, true}) {
    const Messages m = Differing(human ? 2 : 0);
    const arbitration_t& out = StepAt(10, 10, m);
    EXPECT_EQ(out.mode, arbitration_t::EMERGENCY_BRAKING);
    EXPECT_EQ(out.acceleration_mps2, -9);
    EXPECT_EQ(out.lambda_human, human ? 1 : 0) << "authorities are those without it";
    StepAt(10, 0, m);
  }
}

TEST_F(GuardedTest, WarnsAndGivesTheCommandBack) {
  EXPECT_EQ(StepAt(30, 10).mode, arbitration_t::AUTOMATION);
  const arbitration_t& out = StepAt(15, 10);
  EXPECT_EQ(out.mode, arbitration_t::COLLISION_WARNING);
  EXPECT_EQ(out.acceleration_mps2, kAutomation_mps2) << "a warning brakes nothing";
  EXPECT_EQ(StepAt(9, 9).mode, arbitration_t::EMERGENCY_BRAKING);
  EXPECT_EQ(StepAt(8, -0.1).mode, arbitration_t::AUTOMATION);
  EXPECT_EQ(out.acceleration_mps2, kAutomation_mps2);
}

TEST_F(GuardedTest, DoesNotWeakenADriverWhoBrakesHarder) {
  Messages m = Differing(2);
  m.driver.acceleration_mps2 = -9.5;
  EXPECT_EQ(StepAt(10, 10, m).acceleration_mps2, -9.5);
}

TEST_F(GuardedTest, TrustsNoTrackThatTheAccWouldNotUse) {
  Messages m = Differing(0);
  m.track.covariance[0][0] = 100.1;
  EXPECT_EQ(StepAt(10, 10, m).mode, arbitration_t::AUTOMATION);
  m.track.covariance[0][0] = 99.9;
  EXPECT_EQ(StepAt(10, 10, m).mode, arbitration_t::EMERGENCY_BRAKING);
  m.track.covariance[0][0] = 100.1;
  EXPECT_EQ(StepAt(10, 10, m).mode, arbitration_t::AUTOMATION) << "and it ends without one";
}

TEST(ArbitratorTest, DoesNotBrakeByItselfUnlessTheScenarioSaysSo) {
  arbitrator::Arbitrator arbitrator{Scenario()};
  Messages m = Differing(0);
  m.ego.speed_mps = 20;
  m.track.valid = 1;
  m.track.state[0] = 1;
  m.track.state[1] = -20;
  const arbitration_t& out = Step(arbitrator, m);
  EXPECT_EQ(out.acceleration_mps2, kAutomation_mps2);
  EXPECT_EQ(out.mode, arbitration_t::AUTOMATION);
}

TEST(ArbitratorTest, BrakesInAManoeuvreUnderTheManoeuvresMode) {
  Scenario scenario;
  scenario.aeb.enabled = true;
  scenario.arbitrator.window_steps = 1;
  scenario.arbitrator.take_over = {.mode = TakeOverMode::kRequested, .absent_probability = 1};
  arbitrator::Arbitrator arbitrator(scenario);
  Messages m = Differing(2);
  m.ego.speed_mps = 20;
  m.track.valid = 1;
  m.track.state[0] = 40;
  std::int8_t mode = arbitration_t::AUTOMATION;
  for (; mode != arbitration_t::MRM_COMFORT && m.ego.header.step < 300; ++m.ego.header.step) {
    mode = Step(arbitrator, m).mode;
    ASSERT_FALSE(InEmergency(mode));
  }
  ASSERT_EQ(mode, arbitration_t::MRM_COMFORT);
  m.track.state[0] = 5;
  m.track.state[1] = -10;
  const arbitration_t& out = Step(arbitrator, m);
  EXPECT_EQ(out.mode, arbitration_t::MRM_EMERGENCY);
  EXPECT_EQ(out.acceleration_mps2, -9);
  EXPECT_EQ(out.lambda_automation + out.lambda_human, 0);
}

// The arbitrator asks the driver to take over (mode REQUEST). As long as the car brakes in an
// emergency, the mode is EMERGENCY_BRAKING. After the braking, the mode is REQUEST again.
TEST(ArbitratorTest, BrakesAlsoWhileItAsksTheDriver) {
  Scenario scenario;
  scenario.aeb.enabled = true;
  scenario.arbitrator.window_steps = 1;
  scenario.arbitrator.take_over = {.mode = TakeOverMode::kRequested, .severe_ttc_s = 0.5};
  arbitrator::Arbitrator arbitrator(scenario);
  Messages m = Differing(2);
  m.ego.speed_mps = 20;
  m.track.valid = 1;
  m.track.state[0] = 40;
  EXPECT_EQ(Step(arbitrator, m).mode, arbitration_t::REQUEST);
  m.track.state[0] = 15;
  m.track.state[1] = -10;
  EXPECT_EQ(Step(arbitrator, m).mode, arbitration_t::REQUEST) << "the warning does not hide it";
  m.track.state[0] = 9;
  EXPECT_EQ(Step(arbitrator, m).mode, arbitration_t::EMERGENCY_BRAKING);
  m.track.state[1] = 1;
  EXPECT_EQ(Step(arbitrator, m).mode, arbitration_t::REQUEST);
}

TEST(ArbitratorTest, BeginsAManoeuvreAtOnceOnlyForACarThatATrackShowsWithCertainty) {
  Scenario scenario;
  scenario.arbitrator.window_steps = 1;
  scenario.arbitrator.take_over.mode = TakeOverMode::kRequested;
  for (const double std_m : {scenario.acc.max_track_std_m, scenario.acc.max_track_std_m + 0.01}) {
    SCOPED_TRACE(std_m);
    arbitrator::Arbitrator arbitrator(scenario);
    Messages m = Differing(2);
    m.ego.speed_mps = 20;
    EXPECT_EQ(Step(arbitrator, m).mode, arbitration_t::REQUEST);
    m.track.valid = 1;
    m.track.state[0] = 5;
    m.track.state[1] = -10;
    m.track.covariance[0][0] = std_m * std_m;
    const bool certain = std_m <= scenario.acc.max_track_std_m;
    EXPECT_EQ(Step(arbitrator, m).mode,
              certain ? arbitration_t::MRM_EMERGENCY : arbitration_t::REQUEST);
  }
}

}  // namespace
}  // namespace fogline
