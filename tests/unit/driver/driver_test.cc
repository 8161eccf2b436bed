#include "services/driver/driver.h"

#include <gtest/gtest.h>

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
  Driver driver{Scenario()};
  const driver_command_t& command = driver.Step(Truth());
  EXPECT_EQ(command.header.run_id, 9);
  EXPECT_EQ(command.header.step, 4);
  EXPECT_EQ(command.header.utime, 400'000);
}

TEST(DriverTest, DrivesByTheTrueGapAndSpeeds) {
  Scenario scenario;
  Driver driver(scenario);
  EXPECT_EQ(driver.Step(Truth()).acceleration_mps2, Idm(scenario.driver).Acceleration(20, 18, 40));
}

TEST(DriverTest, IsAsReadyAsTheScenarioSays) {
  Scenario scenario;
  EXPECT_EQ(Driver(scenario).Step(Truth()).readiness, 1.0);
  scenario.driver.readiness = 0.25;
  EXPECT_EQ(Driver(scenario).Step(Truth()).readiness, 0.25);
}

TEST(DriverTest, SeesInFogAsInClearAir) {
  Driver driver{Scenario()};
  const double clear = driver.Step(Truth()).acceleration_mps2;
  truth_t fog = Truth();
  fog.fog_present = 1;
  fog.fog_level = 1;
  fog.fog_visibility_m = 20;
  EXPECT_EQ(driver.Step(fog).acceleration_mps2, clear);
}

TEST(DriverTest, HasNoMemory) {
  Driver driver{Scenario()};
  const double first = driver.Step(Truth()).acceleration_mps2;
  truth_t emergency = Truth();
  emergency.host_gap_m = 1;
  EXPECT_LT(driver.Step(emergency).acceleration_mps2, first);
  EXPECT_EQ(driver.Step(Truth()).acceleration_mps2, first);
}

}  // namespace
}  // namespace fogline
