#include "services/driver/driver.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/input_errors.h"

namespace fogline {
namespace {

truth_t Truth() {
  truth_t truth{};
  truth.header = {.run_id = 9, .step = 4, .utime = 400'000};
  truth.preceding_speed_mps = 18;
  truth.host_speed_mps = 20;
  truth.host_gap_m = 40;
  truth.num_followers = 0;
  return truth;
}

TEST(DriverTest, CopiesTheHeader) {
  driver::Driver driver{Scenario()};
  const driver_command_t& command = driver.Step(Truth());
  EXPECT_EQ(command.header.run_id, 9);
  EXPECT_EQ(command.header.step, 4);
  EXPECT_EQ(command.header.utime, 400'000);
}

TEST(DriverTest, DrivesByTheTrueGapAndSpeeds) {
  Scenario scenario;
  driver::Driver driver(scenario);
  EXPECT_EQ(driver.Step(Truth()).acceleration_mps2,
            models::Idm(scenario.driver).Acceleration(20, 18, 40));
}

TEST(DriverTest, IsAsReadyAsTheScenarioSays) {
  Scenario scenario;
  EXPECT_EQ(driver::Driver(scenario).Step(Truth()).readiness, 1.0);
  scenario.driver.readiness = 0.25;
  EXPECT_EQ(driver::Driver(scenario).Step(Truth()).readiness, 0.25);
}

TEST(DriverTest, SeesInFogAsInClearAir) {
  driver::Driver driver{Scenario()};
  const double clear = driver.Step(Truth()).acceleration_mps2;
  truth_t fog = Truth();
  fog.fog_present = 1;
  fog.fog_level = 1;
  fog.fog_visibility_m = 20;
  EXPECT_EQ(driver.Step(fog).acceleration_mps2, clear);
}

TEST(DriverTest, HasNoMemory) {
  driver::Driver driver{Scenario()};
  const double first = driver.Step(Truth()).acceleration_mps2;
  truth_t emergency = Truth();
  emergency.host_gap_m = 1;
  EXPECT_LT(driver.Step(emergency).acceleration_mps2, first);
  EXPECT_EQ(driver.Step(Truth()).acceleration_mps2, first);
}

// ---- scenario section human --------------------------------------------------------------------

/// The TRUTH of a step, in traffic that never becomes steady.
truth_t TruthOf(std::int64_t step) {
  truth_t truth = Truth();
  const auto k = static_cast<double>(step);
  truth.header.step = step;
  truth.preceding_speed_mps = 18 + 2 * std::sin(0.1 * k);
  truth.preceding_acceleration_mps2 = 2 * std::cos(0.1 * k);
  truth.host_acceleration_mps2 = -0.5;
  truth.host_gap_m = 30 + 5 * std::cos(0.03 * k);
  truth.fog_visibility_m = 60;
  return truth;
}

models::Situation SituationOf(const truth_t& truth) {
  return {.speed_mps = truth.host_speed_mps,
          .acceleration_mps2 = truth.host_acceleration_mps2,
          .ahead = models::CarAhead{.gap_m = truth.host_gap_m,
                                    .speed_mps = truth.preceding_speed_mps,
                                    .acceleration_mps2 = truth.preceding_acceleration_mps2}};
}

constexpr std::int64_t kSteps = 60;

/// Expects that the driver's acceleration equals the acceleration of this model in every step.
void ExpectDrives(const Scenario& scenario,
                  const std::function<double(const truth_t& truth)>& model) {
  driver::Driver driver(scenario);
  for (std::int64_t step = 0; step < kSteps; ++step) {
    const truth_t truth = TruthOf(step);
    EXPECT_EQ(driver.Step(truth).acceleration_mps2, model(truth)) << step;
  }
}

TEST(DriverTest, FollowsByTheModelOfTheScenario) {
  for (const auto kind : {FollowingModel::kIdm, FollowingModel::kIidm, FollowingModel::kAccIdm}) {
    Scenario scenario;
    scenario.human.following = kind;
    scenario.human.coolness = 0.7;
    const models::Following model(kind, scenario.driver, 0.7);
    ExpectDrives(scenario,
                 [&](const truth_t& truth) { return model.Acceleration(SituationOf(truth)); });
  }
}

TEST(DriverTest, SeesWhatFogLeavesOfTheTruth) {
  Scenario scenario;
  scenario.human.sight = Sight::kFog;
  const models::FogSight sight(scenario.human.fog_sight);
  const models::Following model(FollowingModel::kIdm, scenario.driver);
  ExpectDrives(scenario, [&](const truth_t& truth) {
    return model.Acceleration(sight.Perceive(SituationOf(truth), truth.fog_visibility_m));
  });
}

TEST(DriverTest, DrivesOnAsOnAFreeRoadWhereFogHidesTheCarAhead) {
  Scenario scenario;
  scenario.human.sight = Sight::kFog;
  truth_t truth = Truth();
  truth.fog_visibility_m = 10;
  const double free = models::Following(FollowingModel::kIdm, scenario.driver)
                          .Acceleration({.speed_mps = truth.host_speed_mps});
  EXPECT_EQ(driver::Driver(scenario).Step(truth).acceleration_mps2, free);
}

TEST(DriverTest, ErrsIsLateAndAnticipatesLikeTheHumanDriverModel) {
  Scenario scenario;
  scenario.seed = 11;
  scenario.human.misjudges = true;
  models::HumanDriver human(scenario.human.errors,
                            models::Following(FollowingModel::kIdm, scenario.driver),
                            Random(11, Stream::kHumanErrors), scenario.step_s);
  ExpectDrives(scenario, [&](const truth_t& truth) {
    return human.Step(truth.header.step, SituationOf(truth));
  });
}

TEST(DriverTest, MisjudgesWhatFogLeavesOfTheTruth) {
  Scenario scenario;
  scenario.human.misjudges = true;
  scenario.human.sight = Sight::kFog;
  const models::FogSight sight(scenario.human.fog_sight);
  models::HumanDriver human(scenario.human.errors,
                            models::Following(FollowingModel::kIdm, scenario.driver),
                            Random(scenario.seed, Stream::kHumanErrors), scenario.step_s);
  ExpectDrives(scenario, [&](const truth_t& truth) {
    return human.Step(truth.header.step,
                      sight.Perceive(SituationOf(truth), truth.fog_visibility_m));
  });
}

TEST(DriverTest, RefusesAStepSoShortThatHeCannotRememberHisReactionTime) {
  Scenario scenario;
  scenario.step_s = 0.003;  // the reaction time of 0.8 s is 266 steps
  EXPECT_NO_THROW(driver::Driver{scenario}) << "this driver has none";
  scenario.human.misjudges = true;
  const auto error = [&] { return test::ErrorOf([&] { const driver::Driver driver(scenario); }); };
  EXPECT_EQ(error(),
            "/step_s: 0.003 s is too short for the driver: human driver: the reaction time is "
            "longer than 254 steps");
  scenario.step_s = 0.005;
  EXPECT_EQ(error(), "");
  // If the driver can lose awareness, the reaction time may grow to 0.8 s + 0.5 x 0.7 s = 1.15 s.
  // In steps of 4 ms, this is 288 steps, and the limit is 254 steps.
  scenario.step_s = 0.004;
  EXPECT_EQ(error(), "");
  scenario.human.loses_awareness = true;
  EXPECT_NE(error(), "");
}

// ---- awareness ---------------------------------------------------------------------------------

class AwarenessOfTheDriverTest : public testing::Test {
 protected:
  static Scenario Losing() {
    Scenario scenario;
    scenario.human.loses_awareness = true;
    return scenario;
  }
  static arbitration_t Host(std::int8_t mode) {
    arbitration_t host{};
    host.mode = mode;
    host.lambda_human = mode == arbitration_t::HUMAN ? 1 : 0;
    host.lambda_automation = 1 - host.lambda_human;
    return host;
  }
  static arbitration_t Stopping() {
    arbitration_t host{};
    host.mode = arbitration_t::MINIMAL_RISK;
    return host;
  }
  /// The driver's readiness in the next step, after this HOST_COMMAND has come.
  double ReadinessAfter(const arbitration_t& host) {
    driver_.SetOnDemandInput(host);
    return driver_.Step(TruthOf(step_++)).readiness;
  }

  Scenario scenario_ = Losing();
  driver::Driver driver_{scenario_};
  models::Awareness awareness_{scenario_.human.awareness};
  std::int64_t step_ = 0;
};

TEST_F(AwarenessOfTheDriverTest, IsTheReadinessThatHeReports) {
  EXPECT_EQ(ReadinessAfter(arbitration_t{}), 1) << "no time has passed";
  for (int k = 0; k < 50; ++k) {
    EXPECT_EQ(ReadinessAfter(Host(arbitration_t::AUTOMATION)),
              awareness_.Step(models::DriverTask::kMonitors, 0.1));
  }
  const double faded = awareness_.awareness();
  EXPECT_LT(faded, 0.97);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(ReadinessAfter(Host(arbitration_t::HUMAN)),
              awareness_.Step(models::DriverTask::kDrives, 0.1));
  }
  EXPECT_GT(awareness_.awareness(), faded);
}

TEST_F(AwarenessOfTheDriverTest, ReturnsAlsoWhileHeIsOnlyAsked) {
  ReadinessAfter(arbitration_t{});
  for (int k = 0; k < 50; ++k) ReadinessAfter(Host(arbitration_t::AUTOMATION));
  arbitration_t request = Host(arbitration_t::AUTOMATION);
  request.mode = arbitration_t::MINIMAL_RISK + 1;  // any mode in which the automation still drives
  const double before = ReadinessAfter(Host(arbitration_t::AUTOMATION));
  EXPECT_GT(ReadinessAfter(request), before);
}

TEST_F(AwarenessOfTheDriverTest, ReturnsUnderACollisionWarningAndEmergencyBraking) {
  for (const std::int8_t mode :
       {arbitration_t::COLLISION_WARNING, arbitration_t::EMERGENCY_BRAKING}) {
    for (int k = 0; k < 50; ++k) ReadinessAfter(Host(arbitration_t::AUTOMATION));
    const double before = ReadinessAfter(Host(arbitration_t::AUTOMATION));
    arbitration_t emergency = Host(arbitration_t::AUTOMATION);
    emergency.mode = mode;
    EXPECT_GT(ReadinessAfter(emergency), before);
  }
}

TEST_F(AwarenessOfTheDriverTest, FadesWhileTheCarStopsByItself) {
  ReadinessAfter(arbitration_t{});
  EXPECT_LT(ReadinessAfter(Stopping()), 1);
}

// In these modes the car has asked the driver, and the state machine still waits for the driver
// (see take_over_table.h).
TEST_F(AwarenessOfTheDriverTest, ReturnsWhileTheCarStopsBecauseHeIsLate) {
  for (const std::int8_t mode :
       {arbitration_t::MRM_COMFORT, arbitration_t::MRM_EMERGENCY, arbitration_t::MRM_FAILED}) {
    for (int k = 0; k < 50; ++k) ReadinessAfter(Host(arbitration_t::AUTOMATION));
    arbitration_t stopping = Stopping();
    stopping.mode = mode;
    const double before = ReadinessAfter(Host(arbitration_t::AUTOMATION));
    ASSERT_LT(before, 0.99);
    EXPECT_NEAR(ReadinessAfter(stopping), std::min(1.0, before + 0.1 * 0.1), 1e-12)
        << static_cast<int>(mode);
  }
  arbitration_t standing = Stopping();
  standing.mode = arbitration_t::MRM_DONE;
  const double before = ReadinessAfter(Host(arbitration_t::AUTOMATION));
  EXPECT_LT(ReadinessAfter(standing), before) << "no task waits for the driver any more";
}

TEST_F(AwarenessOfTheDriverTest, BeginsWithTheReadinessOfTheScenario) {
  scenario_.driver.readiness = 0.7;
  driver::Driver driver(scenario_);
  EXPECT_EQ(driver.Step(TruthOf(0)).readiness, 0.7);
}

TEST_F(AwarenessOfTheDriverTest, FadesAsMuchOverStepsThatAreLeftOut) {
  ReadinessAfter(arbitration_t{});
  step_ += 9;
  EXPECT_NEAR(ReadinessAfter(Host(arbitration_t::AUTOMATION)),
              awareness_.Step(models::DriverTask::kMonitors, 1.0), 1e-15);
}

TEST_F(AwarenessOfTheDriverTest, MakesHimErrMoreAndReactLater) {
  scenario_.human.misjudges = true;
  HumanParameters errors = scenario_.human.errors;
  errors.reaction_time_s = awareness_.LongestReactionTime_s();
  models::HumanDriver human(errors, models::Following(FollowingModel::kIdm, scenario_.driver),
                            Random(scenario_.seed, Stream::kHumanErrors), scenario_.step_s);
  driver::Driver driver(scenario_);
  for (std::int64_t step = 0; step < 200; ++step) {
    const truth_t truth = TruthOf(step);
    if (step > 0) awareness_.Step(models::DriverTask::kMonitors, scenario_.step_s);
    const double faded = 1 - awareness_.awareness();
    // Without awareness, the errors of gap and approach grow as in SUMO's driver state, and the
    // reaction time grows by 0.7 s.
    const models::Attention attention{.reaction_time_s = 0.8 + 0.7 * faded,
                                      .gap_error = 0.05 + 0.75 * 0.2 * faded,
                                      .approach_error_ps = 0.01 + 0.15 * 0.2 * faded};
    EXPECT_NEAR(driver.Step(truth).acceleration_mps2,
                human.Step(step, SituationOf(truth), attention), 1e-9)
        << step;
  }
}

TEST(DriverTest, UsesItsOnDemandInputOnlyIfItsAwarenessDependsOnIt) {
  Scenario scenario;
  EXPECT_FALSE(driver::Driver::UsesOnDemandInput(scenario));
  scenario.human.misjudges = true;
  scenario.human.sight = Sight::kFog;
  EXPECT_FALSE(driver::Driver::UsesOnDemandInput(scenario));
  scenario.human.loses_awareness = true;
  EXPECT_TRUE(driver::Driver::UsesOnDemandInput(scenario));
}

}  // namespace
}  // namespace fogline
