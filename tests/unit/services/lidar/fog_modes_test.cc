#include "services/lidar/fog_modes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/errors.h"

namespace fogline {
namespace {

using lidar::FogMode;

TEST(FogModesTest, MissesFromTheFirstRangeToTheSecondWithAGrowingShare) {
  const lidar::FogModes modes(FogModesSection{});
  EXPECT_EQ(modes.MissingAt(0), 0);
  EXPECT_EQ(modes.MissingAt(25), 0);
  EXPECT_DOUBLE_EQ(modes.MissingAt(27.5), 0.25);
  EXPECT_DOUBLE_EQ(modes.MissingAt(32.5), 0.75);
  EXPECT_EQ(modes.MissingAt(35), 1);
  EXPECT_EQ(modes.MissingAt(100), 1);
}

TEST(FogModesTest, MissesAtOnceBehindLimitsInTheWrongOrder) {
  const lidar::FogModes modes(FogModesSection{.missing_from_m = 40, .missing_beyond_m = 20});
  EXPECT_EQ(modes.MissingAt(40), 0);
  EXPECT_EQ(modes.MissingAt(std::nextafter(40.0, 41.0)), 1);
}

TEST(FogModesTest, SplitsTheUnitIntervalByTheShares) {
  const lidar::FogModes modes(
      FogModesSection{.biased_share = 0.1, .near_echo_share = 0.2, .missing_share = 0.4});
  EXPECT_EQ(modes.ModeOf(0.399, 1, 100), FogMode::kMissing);
  EXPECT_EQ(modes.ModeOf(0.401, 1, 100), FogMode::kNearEcho);
  EXPECT_EQ(modes.ModeOf(0.599, 1, 100), FogMode::kNearEcho);
  EXPECT_EQ(modes.ModeOf(0.601, 1, 100), FogMode::kBiased);
  EXPECT_EQ(modes.ModeOf(0.699, 1, 100), FogMode::kBiased);
  EXPECT_EQ(modes.ModeOf(0.701, 1, 100), FogMode::kRight);
}

TEST(FogModesTest, ScalesAllSharesWithTheLevel) {
  const lidar::FogModes modes(
      FogModesSection{.biased_share = 0.2, .near_echo_share = 0.2, .missing_share = 0.4});
  EXPECT_EQ(modes.ModeOf(0.19, 0.5, 100), FogMode::kMissing);
  EXPECT_EQ(modes.ModeOf(0.29, 0.5, 100), FogMode::kNearEcho);
  EXPECT_EQ(modes.ModeOf(0.39, 0.5, 100), FogMode::kBiased);
  EXPECT_EQ(modes.ModeOf(0.41, 0.5, 100), FogMode::kRight);
  EXPECT_EQ(modes.ModeOf(1e-17, 0, 100), FogMode::kRight);
}

TEST(FogModesTest, GivesTheShareOfANearCarThatIsNotMissingToTheRightValue) {
  const lidar::FogModes modes(FogModesSection{.near_echo_share = 0.5, .missing_share = 0.5});
  EXPECT_EQ(modes.ModeOf(0.49, 1, 20), FogMode::kNearEcho);
  EXPECT_EQ(modes.ModeOf(0.51, 1, 20), FogMode::kRight);
}

TEST(FogModesTest, RefusesSharesThatAddUpToMoreThanOne) {
  try {
    const lidar::FogModes modes(
        FogModesSection{.biased_share = 0.5, .near_echo_share = 0.25, .missing_share = 0.5});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "/fog/modes: biased_share 0.5, near_echo_share 0.25 and missing_share 0.5 add up "
                 "to 1.25; the sum must be at most 1");
  }
  EXPECT_NO_THROW(lidar::FogModes(
      FogModesSection{.biased_share = 0.7, .near_echo_share = 0.1, .missing_share = 0.2}));
}

}  // namespace
}  // namespace fogline
