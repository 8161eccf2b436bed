#include "services/lidar/echo_model.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "services/visibility.h"
#include "tests/unit/services/lidar/crossover_range.h"

namespace fogline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kClear_m = 20000.0;

lidar::EchoModel Model(const LidarBeamSection& beam, double densest_m) {
  return {beam, ExtinctionOf(kClear_m), ExtinctionOf(densest_m)};
}

TEST(EchoModelTest, TheClearTargetIsAtTheThresholdAtItsClearRange) {
  LidarBeamSection beam;
  beam.target_reflectivity = beam.clear_reflectivity;
  const lidar::EchoModel model = Model(beam, 50.0);
  // Clear air has a visibility of 20 km. Over the way to the target and back, it attenuates the
  // echo by 2 alpha R = 0.036 (alpha: extinction coefficient, R: clear_range_m).
  EXPECT_NEAR(model.At(beam.clear_range_m, kClear_m).target,
              -2.0 * ExtinctionOf(kClear_m) * beam.clear_range_m, 1e-12);
}

TEST(EchoModelTest, AttenuationAloneEndsDetectionAtTheAttenuatedRange) {
  LidarBeamSection beam;
  beam.target_reflectivity = beam.clear_reflectivity;
  const lidar::EchoModel model = Model(beam, 20.0);
  for (const double visibility_m : {600.0, 100.0, 50.0, 20.0}) {
    const double range_m = test::AttenuatedRange_m(beam.clear_range_m, ExtinctionOf(visibility_m));
    EXPECT_NEAR(model.At(range_m, visibility_m).target, 0.0, 1e-12);
  }
}

TEST(EchoModelTest, EchoesAreEquallyStrongAtTheCrossover) {
  const LidarBeamSection beam;
  const lidar::EchoModel model = Model(beam, 20.0);
  for (const double visibility_m : {600.0, 100.0, 50.0, 20.0}) {
    const double extinction_pm = ExtinctionOf(visibility_m);
    const double range_m = test::CrossoverRange_m(
        lidar::FindFogPeak(lidar::OpticsOf(beam), extinction_pm).strength_pm,
        beam.target_reflectivity, beam.backscatter_factor / visibility_m, extinction_pm);
    const lidar::EchoPowers echoes = model.At(range_m, visibility_m);
    EXPECT_NEAR(echoes.target, echoes.fog, 1e-3);  // error of the table's interpolation
  }
}

TEST(EchoModelTest, TheTableIsCloseToThePeakItself) {
  // The table has a fixed number of nodes. So its error is largest if the table reaches from clear
  // air to the densest fog that a scenario may have (visibility 5 m).
  const LidarBeamSection beam;
  const lidar::BeamOptics optics = lidar::OpticsOf(beam);
  const lidar::EchoModel model = Model(beam, 5.0);
  for (double visibility_m = 5.0; visibility_m < 30000.0; visibility_m *= 1.07) {
    const lidar::FogPeak peak = lidar::FindFogPeak(optics, ExtinctionOf(visibility_m));
    const double expected = std::log(std::numbers::pi * beam.backscatter_factor / visibility_m /
                                     beam.clear_reflectivity * beam.clear_range_m *
                                     beam.clear_range_m * peak.strength_pm);
    const lidar::EchoPowers echoes = model.At(100.0, visibility_m);
    EXPECT_NEAR(echoes.fog, expected, 2e-3) << visibility_m;
    EXPECT_NEAR(echoes.fog_range_m, peak.range_m, 0.02) << visibility_m;
  }
}

TEST(EchoModelTest, FogOfOneDensityNeedsNoTable) {
  const lidar::EchoModel model = Model(LidarBeamSection{}, kClear_m);
  EXPECT_TRUE(std::isfinite(model.At(33.0, kClear_m).fog));
}

TEST(EchoModelTest, ATargetBeforeTheFogsPeakHidesTheFogBehindIt) {
  const LidarBeamSection beam;
  const lidar::EchoModel model = Model(beam, 30.0);
  const double peak_m = model.At(50.0, 30.0).fog_range_m;
  const lidar::EchoPowers echoes = model.At(peak_m - 1.0, 30.0);
  EXPECT_EQ(echoes.fog_range_m, peak_m - 1.0);
  EXPECT_LT(echoes.fog, model.At(50.0, 30.0).fog);
  EXPECT_GT(echoes.target, echoes.fog + 2.0) << "so near, even thick fog is no rival";
}

TEST(EchoModelTest, TheBeamIsBlindBeforeItsOverlap) {
  const lidar::EchoModel model = Model(LidarBeamSection{}, 30.0);
  for (const double range_m : {0.0, 1.0, 2.0}) {
    EXPECT_EQ(model.At(range_m, 30.0).target, -kInfinity);
    EXPECT_EQ(model.At(range_m, 30.0).fog, -kInfinity);
  }
}

TEST(EchoModelTest, ATargetInTheMiddleOfTheOverlapHasHalfOfThePower) {
  const LidarBeamSection beam;
  const lidar::BeamOptics optics = lidar::OpticsOf(beam);
  const double middle_m = 0.5 * (optics.overlap_start_m + optics.overlap_end_m);
  const double far_m = 2.0 * optics.overlap_end_m;
  const lidar::EchoModel model = Model(beam, 50.0);
  const double loss = 2.0 * ExtinctionOf(kClear_m) * (far_m - middle_m);
  const double ratio = model.At(middle_m, kClear_m).target - model.At(far_m, kClear_m).target;
  EXPECT_NEAR(ratio, std::log(0.5 * far_m * far_m / (middle_m * middle_m)) + loss, 1e-12);
}

TEST(EchoModelTest, FogEchoesAreUndetectableInClearAirAndDetectableInThickFog) {
  const lidar::EchoModel model = Model(LidarBeamSection{}, 30.0);
  EXPECT_LT(model.At(50.0, kClear_m).fog, -3.0);
  EXPECT_GT(model.At(50.0, 30.0).fog, 1.0);
}

TEST(EchoModelTest, IntensityIsOneForTheTargetInClearAirAndFadesWithTheFog) {
  const lidar::EchoModel model = Model(LidarBeamSection{}, 50.0);
  for (const double range_m : {3.0, 10.0, 33.0, 100.0}) {
    const double loss = 2.0 * ExtinctionOf(50.0) * range_m;
    EXPECT_NEAR(model.Intensity(model.At(range_m, 50.0).target, range_m), std::exp(-loss), 1e-12);
  }
  const lidar::EchoPowers echoes = model.At(33.0, 50.0);
  EXPECT_LT(model.Intensity(echoes.fog, echoes.fog_range_m), 0.02);
}

}  // namespace
}  // namespace fogline
