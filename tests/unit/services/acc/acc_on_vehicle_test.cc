// The ACC in a car with an engine, brakes and their delays (services/models/vehicle).
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "services/acc/acc_controller.h"
#include "services/models/vehicle/longitudinal_vehicle.h"
#include "tests/unit/services/acc/two_cars.h"

namespace fogline {
namespace {

struct Course {
  double least_gap_m = 1e9;
  double last_gap_m = 0;
  double last_speed_mps = 0;
  double largest_acceleration_mps2 = 0;
};

// The course of a car that follows a car ahead for a minute, at 20 m/s in the beginning. After 5 s
// the car ahead brakes to 12 m/s at 2 m/s2.
Course FollowABrakingCar(const AccSection& section, VehicleModel model,
                         const models::VehicleParameters& car = models::kSedan) {
  acc::AccController acc(section, kStep_s, model);
  models::LongitudinalVehicle vehicle(car, models::FrictionOf(Surface::kDry), {}, kStep_s);
  models::Motion lead{acc::SafeDistance(section, 20), 20};
  models::Motion own{0, 20};
  vehicle.Begin(own, 0);
  double applied_mps2 = 0;
  Course course;
  for (int k = 0; k < 600; ++k) {
    const acc::AccController::Output output =
        acc.Step({.distance_m = lead.position_m - own.position_m,
                  .relative_speed_mps = lead.speed_mps - own.speed_mps,
                  .speed_mps = own.speed_mps,
                  .acceleration_mps2 = applied_mps2,
                  .has_target = true});
    applied_mps2 = model == VehicleModel::kPointMass ? output.acceleration_mps2
                                                     : vehicle.Step(output.acceleration_mps2, own);
    own = models::Advance(own, applied_mps2, kStep_s);
    lead = models::Advance(lead, k >= 50 && k < 90 ? -2.0 : 0.0, kStep_s);
    course.last_gap_m = lead.position_m - own.position_m;
    course.least_gap_m = std::min(course.least_gap_m, course.last_gap_m);
    course.largest_acceleration_mps2 =
        std::max(course.largest_acceleration_mps2, std::abs(applied_mps2));
  }
  course.last_speed_mps = own.speed_mps;
  return course;
}

TEST(AccOnVehicleTest, KeepsItsDistanceAlmostAsWellAsInAPointMass) {
  for (const double headway_s : {0.8, 1.0, 1.5, 2.0}) {
    AccSection section;
    section.headway_s = headway_s;
    const Course ideal = FollowABrakingCar(section, VehicleModel::kPointMass);
    for (const models::VehicleParameters& car :
         {models::kCompact, models::kSedan, models::kTruck}) {
      const Course real = FollowABrakingCar(section, VehicleModel::kLongitudinal, car);
      // The delay and the lag of the car are half a second together. In half a second, a braking of
      // 2 m/s2 changes the gap by 0.25 m. The car loses gap as long as the car ahead brakes (4 s),
      // so the tolerance is larger: 2 m.
      EXPECT_GT(real.least_gap_m, ideal.least_gap_m - 2) << "headway " << headway_s;
      EXPECT_LT(real.largest_acceleration_mps2, 3.5) << "headway " << headway_s;
      // In the end speed and gap are right, except for a small error that the dead band of the
      // pedals leaves.
      EXPECT_NEAR(real.last_speed_mps, 12, 0.1) << "headway " << headway_s;
      EXPECT_NEAR(real.last_gap_m, acc::SafeDistance(section, 12), 0.5) << "headway " << headway_s;
    }
  }
}

TEST(AccOnVehicleTest, DoesNotRunAwayWhileThePersonDrives) {
  // GIVEN a gap that is far too small, and a driver who keeps the car at a steady speed
  const AccSection section;
  acc::AccController acc(section, kStep_s, VehicleModel::kLongitudinal);
  double command_mps2 = 0;
  for (int k = 0; k < 100; ++k) {
    command_mps2 = acc.Step({.distance_m = 8,
                             .relative_speed_mps = -1,
                             .speed_mps = 20,
                             .acceleration_mps2 = 0,
                             .has_target = true})
                       .acceleration_mps2;
  }
  // THEN the command is negative, and is below the car's acceleration (0) by at most the jerk limit
  // times (engine time constant + one step)
  EXPECT_LT(command_mps2, -1);
  EXPECT_GE(command_mps2, -section.max_jerk_mps3 * (section.engine_time_constant_s + kStep_s));
}

}  // namespace
}  // namespace fogline
