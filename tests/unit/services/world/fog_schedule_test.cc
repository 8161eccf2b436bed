#include "services/world/fog_schedule.h"

#include <cmath>

#include <gtest/gtest.h>

namespace fogline {
namespace {

constexpr std::int64_t kStepUs = 100'000;

TEST(FogScheduleTest, CoversExactlySteps190To299OfThePaper) {
  const world::FogSchedule fog(FogSection{.model = FogModel::kBias});
  for (std::int64_t step = 0; step < 500; ++step) {
    EXPECT_EQ(fog.At(step * kStepUs).present, step >= 190 && step <= 299) << "step " << step;
  }
}

TEST(FogScheduleTest, IsAbsentWithoutAModelOrWithoutAWindow) {
  const world::FogSchedule none(FogSection{.model = FogModel::kNone});
  const world::FogSchedule empty(FogSection{.model = FogModel::kBias, .duration_s = 0.0});
  for (std::int64_t step = 0; step < 500; ++step) {
    EXPECT_FALSE(none.At(step * kStepUs).present);
    EXPECT_EQ(none.At(step * kStepUs).level, 0.0);
    EXPECT_FALSE(empty.At(step * kStepUs).present);
  }
}

TEST(FogScheduleTest, ProfilesHaveTheirShapes) {
  EXPECT_EQ(world::FogLevel(FogProfile::kBox, 0.0), 1.0);
  EXPECT_EQ(world::FogLevel(FogProfile::kBox, 0.999), 1.0);
  for (const FogProfile profile :
       {FogProfile::kHalfSine, FogProfile::kRaisedCosine, FogProfile::kTriangle}) {
    EXPECT_EQ(world::FogLevel(profile, 0.0), 0.0);
    EXPECT_DOUBLE_EQ(world::FogLevel(profile, 0.5), 1.0);
    EXPECT_DOUBLE_EQ(world::FogLevel(profile, 0.25), world::FogLevel(profile, 0.75));
  }
  EXPECT_DOUBLE_EQ(world::FogLevel(FogProfile::kHalfSine, 0.25), std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(world::FogLevel(FogProfile::kRaisedCosine, 0.25), 0.5);
  EXPECT_DOUBLE_EQ(world::FogLevel(FogProfile::kTriangle, 0.25), 0.5);
}

TEST(FogScheduleTest, LevelRunsOverTheWindow) {
  const world::FogSchedule fog(FogSection{.model = FogModel::kBias,
                                          .profile = FogProfile::kTriangle,
                                          .start_s = 2.0,
                                          .duration_s = 4.0});
  EXPECT_EQ(fog.At(1'999'999).level, 0.0);
  EXPECT_DOUBLE_EQ(fog.At(3'000'000).level, 0.5);
  EXPECT_DOUBLE_EQ(fog.At(4'000'000).level, 1.0);
  EXPECT_DOUBLE_EQ(fog.At(5'500'000).level, 0.25);
  EXPECT_EQ(fog.At(6'000'000).level, 0.0);
}

TEST(FogScheduleTest, ModelBiasLeavesTheVisibilityClear) {
  const world::FogSchedule fog(FogSection{.model = FogModel::kBias, .profile = FogProfile::kBox});
  EXPECT_EQ(fog.At(20'000'000).visibility_m, 20000.0);
}

TEST(FogScheduleTest, ModelsBeamAndModesBlendTheExtinctionsOfClearAirAndFog) {
  for (const FogModel model : {FogModel::kBeam, FogModel::kModes}) {
    const world::FogSchedule fog(FogSection{.model = model,
                                            .profile = FogProfile::kTriangle,
                                            .start_s = 0.0,
                                            .duration_s = 4.0,
                                            .visibility_m = 50.0,
                                            .clear_visibility_m = 1000.0});
    EXPECT_DOUBLE_EQ(fog.At(0).visibility_m, 1000.0);
    // Halfway, the extinction is the mean of 3/1000 and 3/50 per metre, which is 3 * 21/2000.
    EXPECT_DOUBLE_EQ(fog.At(1'000'000).visibility_m, 2000.0 / 21.0);
    EXPECT_DOUBLE_EQ(fog.At(2'000'000).visibility_m, 50.0);
    EXPECT_EQ(fog.At(4'000'000).visibility_m, 1000.0);
  }
}

}  // namespace
}  // namespace fogline
