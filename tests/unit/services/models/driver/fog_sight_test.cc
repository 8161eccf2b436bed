#include "services/models/driver/fog_sight.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/unit/services/models/driver/examples.h"

namespace fogline {
namespace {

constexpr double kClearAir = std::numeric_limits<double>::infinity();

models::Situation BehindABrakingCar(double speed_mps, double gap_m, double lead_mps) {
  return Behind(speed_mps, gap_m, lead_mps, -1);
}

TEST(FogSightTest, SeesABlackOutlineAsFarAsTheVisibilityAndAGreyOneLess) {
  FogSightParameters black;
  black.contrast = 1;
  EXPECT_NEAR(models::FogSight(black).OutlineRange(50), 50, 1e-9);
  // With contrast 0.5 and its threshold 0.05, the range is ln(0.5/0.05)/ln 20 = 0.769 of the
  // visibility.
  EXPECT_NEAR(models::FogSight(FogSightParameters{}).OutlineRange(50), 0.7686 * 50, 0.005);
}

struct Lamp {
  double intensity_cd;
  double threshold_lx;
  double range_m;
};

// The ranges of a tail lamp and of a rear fog lamp, by night, at dusk and by day. They follow from
// Allard's law at a visibility of 50 m. The ranges are rounded to metres, so the tolerance is half
// a metre.
TEST(FogSightTest, SeesLampsAsFarAsAllardSays) {
  for (const Lamp& lamp : {Lamp{5, 1e-6, 103}, Lamp{5, 1e-4, 50}, Lamp{5, 1e-3, 29},
                           Lamp{200, 1e-6, 151}, Lamp{200, 1e-4, 91}, Lamp{200, 1e-3, 65}}) {
    FogSightParameters p;
    p.lamp_intensity_cd = lamp.intensity_cd;
    p.illuminance_threshold_lx = lamp.threshold_lx;
    EXPECT_NEAR(models::FogSight(p).LampRange(50), lamp.range_m, 0.5)
        << lamp.intensity_cd << " cd, " << lamp.threshold_lx << " lx";
  }
}

TEST(FogSightTest, FulfilsAllardsLawAtTheRange) {
  const FogSightParameters p;
  for (const double visibility_m : {20.0, 50.0, 300.0, 5000.0}) {
    const double d = models::FogSight(p).LampRange(visibility_m);
    EXPECT_NEAR(p.lamp_intensity_cd * std::exp(-std::log(20) / visibility_m * d) / (d * d) /
                    p.illuminance_threshold_lx,
                1, 1e-9);
  }
}

TEST(FogSightTest, SeesAnyOutlineInClearAirAndLampsByTheInverseSquare) {
  const models::FogSight sight{FogSightParameters{}};
  EXPECT_EQ(sight.OutlineRange(kClearAir), kClearAir);
  EXPECT_NEAR(sight.LampRange(kClearAir), std::sqrt(5 / 1e-4), 1e-9);
  const models::Situation perceived = sight.Perceive(BehindABrakingCar(20, 60, 15), kClearAir);
  EXPECT_EQ(perceived.ahead->gap_m, 60);
}

TEST(FogSightTest, LosesOutlineThenLamps) {
  const models::FogSight sight{FogSightParameters{}};  // in fog of 50 m: outline 38.4 m, lamps 50 m
  EXPECT_EQ(sight.At(38, 50), models::Seen::kOutline);
  EXPECT_EQ(sight.At(39, 50), models::Seen::kLamps);
  EXPECT_EQ(sight.At(51, 50), models::Seen::kNothing);
  EXPECT_FALSE(sight.Perceive(BehindABrakingCar(20, 51, 10), 50).ahead.has_value());
  EXPECT_EQ(sight.Perceive(BehindABrakingCar(20, 51, 10), 50).speed_mps, 20);
}

TEST(FogSightTest, MisjudgesDistanceMoreTheVaguerTheOutline) {
  FogSightParameters p;
  p.lamp_distance_factor = 1.4;
  const models::FogSight sight(p);
  const double outline_m = sight.OutlineRange(50);
  const auto factor = [&](double gap_m) {
    return sight.Perceive(BehindABrakingCar(20, gap_m, 10), 50).ahead->gap_m / gap_m;
  };
  EXPECT_EQ(factor(0.5 * outline_m), 1);
  EXPECT_NEAR(factor(0.75 * outline_m), 1.2, 1e-12);
  EXPECT_NEAR(factor(outline_m), 1.4, 1e-12);
  EXPECT_NEAR(factor(45), 1.4, 1e-12);
}

TEST(FogSightTest, OverlooksClosingInBelowTheAngularThreshold) {
  const models::FogSight sight{FogSightParameters{}};
  // The driver sees that the gap closes if W dv / d^2 > 0.003 rad/s. With the car's width W = 1.8 m
  // and d = 30 m, this is dv > 1.5 m/s.
  EXPECT_EQ(sight.Perceive(BehindABrakingCar(20, 30, 18.51), 1000).ahead->speed_mps, 20);
  EXPECT_EQ(sight.Perceive(BehindABrakingCar(20, 30, 18.51), 1000).ahead->acceleration_mps2, 0);
  EXPECT_EQ(sight.Perceive(BehindABrakingCar(20, 30, 18.49), 1000).ahead->speed_mps, 18.49);
  EXPECT_EQ(sight.Perceive(BehindABrakingCar(20, 30, 18.49), 1000).ahead->acceleration_mps2, -1);
  EXPECT_EQ(sight.Perceive(BehindABrakingCar(20, 30, 21.51), 1000).ahead->speed_mps, 21.51);
  // At 45 m only the lamps are visible, which are 1.3 m apart. So the driver sees that the gap
  // closes if 1.3 dv / 45^2 > 0.003 rad/s, which is dv > 4.67 m/s.
  EXPECT_EQ(sight.Perceive(BehindABrakingCar(20, 45, 15.34), 50).ahead->speed_mps, 20);
  EXPECT_EQ(sight.Perceive(BehindABrakingCar(20, 45, 15.32), 50).ahead->speed_mps, 15.32);
}

TEST(FogSightTest, LeavesAFreeRoadFree) {
  EXPECT_FALSE(
      models::FogSight(FogSightParameters{}).Perceive({.speed_mps = 20}, 50).ahead.has_value());
}

TEST(FogSightTest, RefusesAContrastBelowItsThreshold) {
  FogSightParameters p;
  p.contrast = 0.04;
  EXPECT_THROW(models::FogSight{p}, std::invalid_argument);
}

}  // namespace
}  // namespace fogline
