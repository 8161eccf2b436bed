#include "services/models/vehicle/grade_profile.h"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(GradeProfileTest, IsLevelWithoutPoints) { EXPECT_EQ(models::GradeProfile().GradeAt(123), 0); }

TEST(GradeProfileTest, RisesBetweenPointsAndStaysOutside) {
  const models::GradeProfile hill({{100, 0.0}, {200, 0.05}, {300, -0.03}});
  EXPECT_EQ(hill.GradeAt(-50), 0);
  EXPECT_DOUBLE_EQ(hill.GradeAt(150), 0.025);
  EXPECT_DOUBLE_EQ(hill.GradeAt(200), 0.05);
  EXPECT_DOUBLE_EQ(hill.GradeAt(275), -0.01);
  EXPECT_EQ(hill.GradeAt(1e6), -0.03);
}

TEST(GradeProfileTest, NamesThePlaceThatDoesNotComeAfterTheOneBefore) {
  try {
    models::GradeProfile({{0, 0}, {150, 0.1}, {120, 0}});
    FAIL() << "was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "/road/grade/2/position_m: 120 m does not come after 150 m, the place before it; "
                 "places must increase");
  }
}

TEST(GradeProfileTest, RefusesPointsOutOfOrder) {
  EXPECT_THROW(models::GradeProfile({{10, 0}, {10, 0.1}}), std::invalid_argument);
  EXPECT_THROW(models::GradeProfile({{10, std::numeric_limits<double>::quiet_NaN()}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace fogline
