#include "services/models/vehicle/longitudinal_vehicle.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kDry = models::FrictionOf(Surface::kDry);

// A car on a road. The car moves as in the world.
class Drive {
 public:
  Drive(const models::VehicleParameters& vehicle, double speed_mps, double command_mps2 = 0,
        double friction = kDry, models::GradeProfile road = {})
      : car_(vehicle, friction, std::move(road), kStep_s), motion_{0, speed_mps} {
    car_.Begin(motion_, command_mps2);
  }

  // @return the mean acceleration of the last step
  double For(double duration_s, double command_mps2) {
    double change_mps = 0;
    for (int i = 0; i < std::lround(duration_s / kStep_s); ++i) {
      const double before_mps = motion_.speed_mps;
      motion_ = models::Advance(motion_, car_.Step(command_mps2, motion_), kStep_s);
      change_mps = motion_.speed_mps - before_mps;
    }
    return change_mps / kStep_s;
  }

  const models::Motion& motion() const { return motion_; }
  const models::LongitudinalVehicle& car() const { return car_; }

 private:
  models::LongitudinalVehicle car_;
  models::Motion motion_;
};

double DragFactor(const models::VehicleParameters& p) {
  return 0.5 * models::kAirDensity_kgpm3 * p.drag_coefficient * p.frontal_area_m2;
}
double Rolling(const models::VehicleParameters& p) {
  return p.rolling_coefficient * p.mass_kg * models::kGravity_mps2;
}

class EveryVehicleTest : public testing::TestWithParam<models::VehicleParameters> {};
INSTANTIATE_TEST_SUITE_P(Sets, EveryVehicleTest,
                         testing::Values(models::kCompact, models::kSedan, models::kTruck));

TEST_P(EveryVehicleTest, EndsAtTheSpeedWhereItsPowerIsUsedUp) {
  // At the final speed v, drag c v^2 and rolling resistance R use up the power: P = c v^3 + R v.
  // Cardano's formula gives v, with p = R/c and r = P/c.
  const models::VehicleParameters& vehicle = GetParam();
  const double p = Rolling(vehicle) / DragFactor(vehicle);
  const double r = vehicle.power_w / DragFactor(vehicle);
  const double root = std::sqrt(r * r / 4 + p * p * p / 27);
  const double terminal_mps = std::cbrt(r / 2 + root) + std::cbrt(r / 2 - root);

  Drive drive(vehicle, 0.9 * terminal_mps);
  const double acceleration = drive.For(3000, 3);

  EXPECT_NEAR(drive.motion().speed_mps, terminal_mps, 1e-6);
  EXPECT_NEAR(acceleration, 0, 1e-9);
}

TEST_P(EveryVehicleTest, CoastsDownAsTheClosedFormSays) {
  // With rolling resistance R, drag c v^2, and the mass m_eff that includes rotating parts, the
  // equation of motion is m_eff dv/dt = -R - c v^2. Its solution is v = w tan(atan(v0 / w) - sqrt(R
  // c) t / m_eff), with w = sqrt(R / c).
  const models::VehicleParameters& vehicle = GetParam();
  const double c = DragFactor(vehicle);
  const double rolling = Rolling(vehicle);
  const double mass = vehicle.rotating_mass_factor * vehicle.mass_kg;
  const double w = std::sqrt(rolling / c);
  const double from_mps = 30;
  const auto expected_mps = [&](double t) {
    return w * std::tan(std::atan(from_mps / w) - std::sqrt(rolling * c) * t / mass);
  };
  // The command is within the dead band around coasting (rolling and drag), so no pedal is pressed.
  models::VehicleParameters coasting = vehicle;
  coasting.pedal_dead_band_mps2 = 5;
  Drive drive(coasting, from_mps, -1);
  for (const double t : {10.0, 20.0, 30.0}) {
    drive.For(10, -1);
    EXPECT_NEAR(drive.motion().speed_mps, expected_mps(t), 1e-9) << t << " s";
  }
}

TEST_P(EveryVehicleTest, FollowsASteadyCommandWithinItsLimits) {
  Drive level(GetParam(), 20);
  EXPECT_NEAR(level.For(5, 0), 0, 1e-9);
  for (const double command : {0.1, -0.5, -2.0}) {
    Drive drive(GetParam(), 20, command);
    // Drag changes with the speed, and its compensation is late by delay and lag. The error is the
    // share 2 c v (D + tau) / m_eff of the command, with the drag c v^2, the delay D, the lag tau
    // and the effective mass m_eff. At 20 m/s it is below 1 % for each of the three cars.
    EXPECT_NEAR(drive.For(5, command), command, 0.01 * std::abs(command)) << command;
  }
}

TEST(LongitudinalVehicleTest, LosesHalfAMetrePerSecondSquaredOnFivePercent) {
  models::VehicleParameters frictionless;
  frictionless.rotating_mass_factor = 1;
  frictionless.drag_coefficient = 0;
  frictionless.rolling_coefficient = 0;
  frictionless.pedal_dead_band_mps2 = 5;
  Drive drive(frictionless, 20, -0.49, kDry, models::GradeProfile({{0, 0.05}}));
  EXPECT_NEAR(drive.For(1, -0.49), -0.4897, 5e-5);  // g * 0.05 / sqrt(1 + 0.05^2)
}

TEST(LongitudinalVehicleTest, HoldsItsSpeedUphill) {
  Drive drive(models::kSedan, 20, 0, kDry, models::GradeProfile({{0, 0.05}}));
  drive.For(30, 0);
  EXPECT_NEAR(drive.motion().speed_mps, 20, 1e-9);
  EXPECT_NEAR(drive.car().traction_n(),
              Rolling(models::kSedan) / std::sqrt(1.0025) + DragFactor(models::kSedan) * 400 +
                  1500 * 0.489721,
              0.01);
}

TEST(LongitudinalVehicleTest, BrakesOnIceWithFrictionTimesGravityAtMost) {
  models::VehicleParameters without_drag;
  without_drag.drag_coefficient = 0;
  const double mu = models::FrictionOf(Surface::kIce);
  Drive drive(without_drag, 20, 0, mu);
  EXPECT_NEAR(drive.For(2, -6), -mu * models::kGravity_mps2, 1e-12);

  Drive dry(without_drag, 20, 0, models::FrictionOf(Surface::kDry));
  EXPECT_NEAR(dry.For(2, -6), -6, 0.01);
}

TEST(LongitudinalVehicleTest, SpinsItsWheelsOnIceAtTheDrivenShareOfFriction) {
  models::VehicleParameters without_drag;
  without_drag.drag_coefficient = 0;
  const double mu = models::FrictionOf(Surface::kIce);
  Drive drive(without_drag, 2, 0, mu);
  EXPECT_NEAR(drive.For(3, 3), without_drag.driven_weight_share * mu * models::kGravity_mps2,
              1e-12);
}

TEST(LongitudinalVehicleTest, BrakesNoHarderThanItsBrakesCan) {
  models::VehicleParameters weak;  // only the brakes act on this car
  weak.rotating_mass_factor = 1;
  weak.drag_coefficient = 0;
  weak.rolling_coefficient = 0;
  weak.max_brake_mps2 = 6;
  Drive drive(weak, 30, -8);
  EXPECT_NEAR(drive.For(1, -8), -6, 1e-12);
}

TEST(LongitudinalVehicleTest, BrakesWithDelayAndLag) {
  models::VehicleParameters light = models::kSedan;  // only the brakes act on this car
  light.drag_coefficient = 0;
  light.rolling_coefficient = 0;
  light.pedal_dead_band_mps2 = 0;
  light.brake_delay_s = 0.2;
  light.brake_lag_s = 0.5;
  Drive drive(light, 30);
  EXPECT_EQ(drive.For(0.2, -4), 0);
  drive.For(0.4, -4);
  const double before = drive.For(0.1, -4);  // mean from 0.6 to 0.7 s
  const double after = drive.For(0.1, -4);   // mean from 0.7 to 0.8 s
  // 0.7 s is the delay plus the time constant. At this time, the brakes have reached 63.2 % of the
  // commanded deceleration. The average of `before` and `after` is the mean from 0.6 s to 0.8 s,
  // with 0.7 s in the middle. The tolerance covers the curvature of the force over these 0.2 s.
  EXPECT_NEAR(0.5 * (before + after), -4 * (1 - std::exp(-1)), 4 * 0.004);
}

TEST(LongitudinalVehicleTest, DoesNotTouchThePedalsForATremblingCommand) {
  Drive drive(models::kSedan, 20);
  int changes = 0;
  models::Pedal pedal = drive.car().pedal();
  // The commands alternate around the acceleration of coasting, where the demanded force is 0.
  const double coasting =
      -(Rolling(models::kSedan) + DragFactor(models::kSedan) * 400) / (1.05 * 1500);
  for (int i = 0; i < 100; ++i) {
    drive.For(kStep_s, coasting + (i % 2 == 0 ? 0.05 : -0.05));
    if (drive.car().pedal() != pedal) ++changes;
    pedal = drive.car().pedal();
  }
  EXPECT_EQ(changes, 0);
}

TEST(LongitudinalVehicleTest, StopsWithinTheStepAndStands) {
  Drive drive(models::kSedan, 0.15, -3);
  drive.For(0.1, -3);
  EXPECT_EQ(drive.motion().speed_mps, 0);
  EXPECT_NEAR(drive.motion().position_m, 0.15 * 0.15 / (2 * 3), 1e-4);
  const double there_m = drive.motion().position_m;
  drive.For(5, 0);
  EXPECT_EQ(drive.motion().position_m, there_m);
}

TEST(LongitudinalVehicleTest, HasNoAccelerationWhileTheBrakesHoldItAtRest) {
  models::LongitudinalVehicle car(models::kSedan, kDry, {}, kStep_s);
  car.Begin({}, -3);
  EXPECT_EQ(car.Step(-3, {}), 0);
}

TEST(LongitudinalVehicleTest, DoesNotRollBackwards) {
  Drive drive(models::kTruck, 0, 0, kDry, models::GradeProfile({{0, 0.1}}));
  drive.For(10, -1);
  EXPECT_EQ(drive.motion().position_m, 0);
}

TEST(LongitudinalVehicleTest, RefusesParametersOutOfRange) {
  models::VehicleParameters massless;
  massless.mass_kg = 0;
  EXPECT_THROW(models::LongitudinalVehicle(massless, kDry, {}, kStep_s), std::invalid_argument);
  EXPECT_THROW(models::LongitudinalVehicle(models::kSedan, 0, {}, kStep_s), std::invalid_argument);
  models::VehicleParameters eager;
  eager.brake_delay_s = -1;
  EXPECT_THROW(models::LongitudinalVehicle(eager, kDry, {}, kStep_s), std::invalid_argument);
}

}  // namespace
}  // namespace fogline
