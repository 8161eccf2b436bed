#include "services/decision/conflict/disagreement.h"

#include <gtest/gtest.h>

#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {
namespace {

conflict::ConflictParameters With(MissingLidar rule) {
  conflict::ConflictParameters parameters;
  parameters.missing = rule;
  return parameters;
}

TEST(DisagreementTest, IsRadarLessLidarLessOffset) {
  conflict::ConflictParameters parameters;
  parameters.offset_m = 0.5;
  conflict::DisagreementSource source(parameters);
  const auto disagreement = source.Next(LidarShortBy(2, 3, 4));
  ASSERT_TRUE(disagreement);
  EXPECT_EQ(disagreement->difference_m, 1.5);
  EXPECT_EQ(disagreement->variance_m2(), 25);
  EXPECT_EQ(disagreement->standardised(), 0.3);
}

TEST(DisagreementTest, HoldsNothingBeforeTheFirstMeasurement) {
  conflict::DisagreementSource source(With(MissingLidar::kHold));
  EXPECT_FALSE(source.Next(WithoutRadar(LidarShortBy(2))));
  EXPECT_TRUE(source.Next(LidarShortBy(2)));
  EXPECT_EQ(source.Next(WithoutRadar(LidarShortBy(9)))->difference_m, 2);
}

TEST(DisagreementTest, HoldsNothingAfterReset) {
  conflict::DisagreementSource source(With(MissingLidar::kHold));
  ASSERT_TRUE(source.Next(LidarShortBy(2)));
  source.Reset();
  EXPECT_FALSE(source.Next(WithoutRadar(LidarShortBy(2))));
}

TEST(DisagreementTest, MissingValueAsConflictHasTheLastStatedPrecision) {
  const conflict::ConflictParameters parameters = With(MissingLidar::kConflict);
  conflict::DisagreementSource source(parameters);
  source.Next(LidarShortBy(2, 3, 4));
  const auto disagreement = source.Next(WithoutLidar(LidarShortBy(2, 5, 6)));
  EXPECT_EQ(disagreement->difference_m, parameters.missing_conflict_m);
  EXPECT_EQ(disagreement->radar_std_m, 5);  // from this step
  EXPECT_EQ(disagreement->lidar_std_m, 4);  // the last value that the LiDAR stated
}

TEST(DisagreementTest, MissingValueAsConflictHasTheNominalPrecisionAtFirstAndAfterReset) {
  const conflict::ConflictParameters parameters = With(MissingLidar::kConflict);
  conflict::DisagreementSource source(parameters);
  EXPECT_EQ(source.Next({})->radar_std_m, parameters.nominal_radar_std_m);
  source.Next(LidarShortBy(2, 3, 4));
  source.Reset();
  EXPECT_EQ(source.Next({})->radar_std_m, parameters.nominal_radar_std_m);
  EXPECT_EQ(source.Next({})->lidar_std_m, parameters.nominal_lidar_std_m);
}

TEST(DisagreementTest, PrecisionBelowTheSmallestCountsAsTheSmallest) {
  const conflict::ConflictParameters parameters;
  conflict::DisagreementSource source(parameters);
  EXPECT_EQ(source.Next(LidarShortBy(2, 0, 0))->lidar_std_m, parameters.smallest_std_m);
}

}  // namespace
}  // namespace fogline
