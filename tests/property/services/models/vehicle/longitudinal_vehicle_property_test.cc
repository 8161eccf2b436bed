#include "services/models/vehicle/longitudinal_vehicle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include "common/random.h"

namespace fogline {
namespace {

constexpr std::int64_t kDrives = 300;
constexpr std::int64_t kSteps = 300;

double Between(double low, double high, double u) { return low + (high - low) * u; }

models::VehicleParameters AnyVehicle(const Random& random, std::int64_t index) {
  constexpr std::array<models::VehicleParameters, 3> kSets{models::kCompact, models::kSedan,
                                                           models::kTruck};
  const auto [set, _] = random.Uniform2(index, 0);
  return kSets[static_cast<std::size_t>(3 * set)];
}

models::GradeProfile AnyHill(const Random& random, std::int64_t index) {
  const auto [a, b] = random.Uniform2(index, 1);
  const auto [c, d] = random.Uniform2(index, 2);
  return models::GradeProfile({{0, Between(-0.1, 0.1, a)},
                               {50, Between(-0.1, 0.1, b)},
                               {90, Between(-0.1, 0.1, c)},
                               {300, Between(-0.1, 0.1, d)}});
}

// Commands from -12 to 6 m/s2. Many of them are beyond the abilities of the car. Each command lasts
// for 7 steps.
double AnyCommand(const Random& random, std::int64_t index, std::int64_t step) {
  const auto [a, b] = random.Uniform2(index * kSteps + step / 7, 3);
  return b < 0.2 ? 0 : Between(-12, 6, a);
}

TEST(LongitudinalVehicleProperty, NeverMakesEnergyAndNeverGoesBackwards) {
  const Random random(11, Stream::kRadar);
  for (std::int64_t drive = 0; drive < kDrives; ++drive) {
    const auto [h, f] = random.Uniform2(drive, 4);
    const auto [v, t] = random.Uniform2(drive, 5);
    const double step_s = Between(0.02, 0.2, h);
    const double mu = Between(0.1, 1.0, f);
    const models::VehicleParameters vehicle = AnyVehicle(random, drive);
    const models::GradeProfile road = AnyHill(random, drive);
    models::LongitudinalVehicle car(vehicle, mu, road, step_s);
    models::Motion motion{0, 40 * v * v};
    car.Begin(motion, 0);
    for (std::int64_t step = 0; step < kSteps; ++step) {
      const double acceleration = car.Step(AnyCommand(random, drive, step), motion);
      const models::Motion next = models::Advance(motion, acceleration, step_s);
      ASSERT_GE(next.speed_mps, 0);
      ASSERT_GE(next.position_m, motion.position_m);
      const double path_m = next.position_m - motion.position_m;

      // The energy from the engine in this step; the power of the engine limits this energy.
      const double engine_j = car.traction_n() * path_m;
      ASSERT_LE(engine_j, vehicle.power_w * step_s * (1 + 1e-2));
      // Kinetic energy of car and wheels, and potential energy. The path may be flatter in its
      // middle than at its ends, because the grade changes by up to 0.2 in 40 m. So `grade` is a
      // lower bound.
      const double kinetic_j =
          0.5 * vehicle.rotating_mass_factor * vehicle.mass_kg *
          (next.speed_mps * next.speed_mps - motion.speed_mps * motion.speed_mps);
      const double grade =
          std::min(road.GradeAt(motion.position_m), road.GradeAt(next.position_m)) - 5e-3 * path_m;
      const double height_j =
          vehicle.mass_kg * models::kGravity_mps2 * path_m * grade / std::sqrt(1 + grade * grade);
      ASSERT_LE(kinetic_j + height_j, engine_j + 1e-6) << "drive " << drive << " step " << step;
      // The limits of the tyres. On a slope, gravity may make the braking or the acceleration
      // larger than these limits.
      const double slope_mps2 = models::kGravity_mps2 * 0.1;
      const double drag_mps2 = 0.5 * models::kAirDensity_kgpm3 * vehicle.drag_coefficient *
                               vehicle.frontal_area_m2 * motion.speed_mps * motion.speed_mps /
                               vehicle.mass_kg;
      ASSERT_GE(acceleration, -mu * models::kGravity_mps2 - slope_mps2 - drag_mps2 - 1e-9);
      ASSERT_LE(acceleration, mu * models::kGravity_mps2 + slope_mps2);
      motion = next;
    }
  }
}

// Commands that begin at 0, 4, 8, ... s. 4 s is a multiple of every step of these tests.
using Commands = std::array<double, 6>;

struct Error {
  double speed_mps = 0;
  double position_m = 0;
};

// The motion after 24 s over a hill.
models::Motion DriveWith(const Commands& commands, double step_s) {
  models::LongitudinalVehicle car(models::kSedan, 0.9,
                                  models::GradeProfile({{0, 0.0}, {800, 0.06}}), step_s);
  models::Motion motion{0, 22};
  car.Begin(motion, 0);
  const auto steps_each = static_cast<std::int64_t>(std::lround(4 / step_s));
  for (const double command : commands) {
    for (std::int64_t i = 0; i < steps_each; ++i) {
      motion = models::Advance(motion, car.Step(command, motion), step_s);
    }
  }
  return motion;
}

// The error in comparison with steps of 1/640 s.
Error ErrorOf(const Commands& commands, double step_s) {
  const models::Motion reference = DriveWith(commands, 0.4 / 256);
  const models::Motion motion = DriveWith(commands, step_s);
  return {std::abs(motion.speed_mps - reference.speed_mps),
          std::abs(motion.position_m - reference.position_m)};
}

TEST(LongitudinalVehicleProperty, HalvingTheStepQuartersTheError) {
  const Commands within_limits{0.4, 0.8, 0.5, 0.2, 0.6, 0.3};
  Error last = ErrorOf(within_limits, 0.4);
  for (const double step_s : {0.2, 0.1, 0.05, 0.025}) {
    const Error error = ErrorOf(within_limits, step_s);
    EXPECT_GT(last.speed_mps / error.speed_mps, 3.5) << "step " << step_s;
    EXPECT_GT(last.position_m / error.position_m, 3.5) << "step " << step_s;
    last = error;
  }
}

// If a limit begins to hold or the pedal changes within a step, the error depends on the moment
// within the step. So the test compares only the coarsest and the finest step: a step sixteen times
// smaller must have an error at least sixteen times smaller.
TEST(LongitudinalVehicleProperty, ConvergesThroughPowerLimitAndPedalChanges) {
  const Commands hard{0.4, 3.5, 3.5, -2.0, 0.2, -0.5};
  const Error coarse = ErrorOf(hard, 0.4);
  const Error fine = ErrorOf(hard, 0.025);
  EXPECT_GT(coarse.speed_mps / fine.speed_mps, 16);
  EXPECT_GT(coarse.position_m / fine.position_m, 16);
  EXPECT_LT(fine.speed_mps, 0.01);
}

}  // namespace
}  // namespace fogline
