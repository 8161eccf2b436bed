#include "services/decision/conflict/over_time/third_witness.h"

#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "services/decision/conflict/conflict_measures.h"
#include "tests/support/find_row.h"
#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {
namespace {

constexpr double kEven = 1e-12;

std::unique_ptr<conflict::BlameMeasure> Make(std::string_view name,
                                             const conflict::ConflictParameters& parameters = {}) {
  return test::FindBlameMeasure(name)->make(parameters);
}

class EveryBlameTest : public testing::TestWithParam<std::string_view> {};

TEST_P(EveryBlameTest, FallsOnTheLidarThatLeavesRadarAndPrediction) {
  const conflict::Blame blame = Make(GetParam())->Step(LidarShortBy(5));
  EXPECT_GT(blame.lidar, 0.8);
  EXPECT_LT(blame.radar, 0.55);  // above 0 because Murphy's average includes the LiDAR
}

TEST_P(EveryBlameTest, FallsOnTheRadarThatLeavesLidarAndPrediction) {
  const conflict::Blame blame = Make(GetParam())->Step(RadarLongBy(5));
  EXPECT_GT(blame.radar, 0.8);
  EXPECT_LT(blame.lidar, 0.55);
}

TEST_P(EveryBlameTest, FallsOnNoSensorWhenAllAgree) {
  const conflict::Blame blame = Make(GetParam())->Step(LidarShortBy(0));
  EXPECT_NEAR(blame.radar, 0, kEven);
  EXPECT_NEAR(blame.lidar, 0, kEven);
}

TEST_P(EveryBlameTest, FallsOnNoSensorWithoutAWitness) {
  conflict::Evidence evidence = LidarShortBy(5);
  evidence.prediction = {};
  EXPECT_EQ(Make(GetParam())->Step(evidence), conflict::Blame{});
  // Without a prediction no sensor is blamed, even if the steps before had a prediction.
  const auto measure = Make(GetParam());
  for (int i = 0; i < 3; ++i) EXPECT_GT(measure->Step(LidarShortBy(5)).lidar, 0.8);
  EXPECT_EQ(measure->Step(evidence), conflict::Blame{});
}

TEST_P(EveryBlameTest, GrowsWithTheErrorOfTheLidar) {
  double last = 0;
  for (double error_m = 0; error_m < 8; error_m += 0.125) {
    const double blame = Make(GetParam())->Step(LidarShortBy(error_m)).lidar;
    EXPECT_GE(blame, last - kEven) << error_m;
    last = blame;
  }
}

TEST_P(EveryBlameTest, MissingValueIsHeldSkippedOrBlamed) {
  const auto after_dropout = [](MissingLidar rule) {
    conflict::ConflictParameters parameters;
    parameters.missing = rule;
    const auto measure = Make(GetParam(), parameters);
    const conflict::Blame before = measure->Step(LidarShortBy(0.3));
    return std::pair{before, measure->Step(WithoutLidar(LidarShortBy(0.3)))};
  };
  const auto [measured, held] = after_dropout(MissingLidar::kHold);
  EXPECT_EQ(held.lidar, measured.lidar);
  EXPECT_EQ(after_dropout(MissingLidar::kSkip).second.lidar, 0);
  EXPECT_GT(after_dropout(MissingLidar::kConflict).second.lidar, 0.999);
}

INSTANTIATE_TEST_SUITE_P(Of, EveryBlameTest, testing::Values("nis", "deng", "murphy", "mutual"),
                         [](const auto& name) { return std::string(name.param); });

TEST(NisBlameTest, IsTheChiSquareProbabilityOfTheResidual) {
  // The residual is 2 standard deviations. 0.9545 of the normal distribution is within 2 standard
  // deviations.
  const conflict::Evidence evidence{
      .radar = {true, 10, 0.3}, .lidar = {true, 11, 0.3}, .prediction = {true, 10, 0.4}};
  conflict::NisBlame blame({});
  EXPECT_EQ(blame.Step(evidence).radar, 0);
  EXPECT_NEAR(blame.Step(evidence).lidar, 0.9545, 5e-5);
  EXPECT_NEAR(blame.largest_square(), 4, 1e-12);
}

TEST(NisBlameTest, AWindowAddsUpWhatSingleStepsCannotTell) {
  conflict::ConflictParameters parameters;
  parameters.blame_window_steps = 9;
  conflict::NisBlame blame(parameters);
  double last = 0;
  for (int i = 0; i < 9; ++i) last = blame.Step(LidarShortBy(std::hypot(kLidarStd_m, 0.1))).lidar;
  EXPECT_NEAR(last, std::erf(3 / std::sqrt(2.0)), 1e-12);  // the statistic is 1 * sqrt(9)
}

TEST(NisBlameTest, ALidarThatIsShortAndThenSilentIsNotExcusedByTheSilence) {
  conflict::ConflictParameters parameters;
  parameters.blame_window_steps = 2;
  parameters.missing = MissingLidar::kConflict;
  conflict::NisBlame blame(parameters);
  blame.Step(LidarShortBy(parameters.missing_conflict_m));
  EXPECT_EQ(blame.Step(WithoutLidar(LidarShortBy(0))).lidar, 1);
}

TEST(NisBlameTest, TakesTheOffsetOffTheRadar) {
  conflict::ConflictParameters parameters;
  parameters.offset_m = 0.9;
  conflict::NisBlame blame(parameters);
  EXPECT_NEAR(blame.Step(RadarLongBy(0.9)).radar, 0, kEven);
}

TEST(SupportTest, OfTwoSourcesCannotTellWhichIsWrong) {
  // GIVEN: the belief of the prediction has no interval in common with the beliefs of radar and
  // LiDAR. So the prediction counts as missing.
  const conflict::BeliefProducts products{
      .square = 0.6, .radar_lidar = 0.2, .radar_prediction = 0, .lidar_prediction = 0};
  for (const auto support : {conflict::DengSupport, conflict::MutualSupport}) {
    EXPECT_EQ(support(products).radar, 0.5);
    EXPECT_EQ(support(products).lidar, 0.5);
  }
  EXPECT_EQ(conflict::MurphySupport(products).radar, conflict::MurphySupport(products).lidar);
}

TEST(SupportTest, IsAnEqualShareWhereNothingResemblesAnything) {
  const conflict::BeliefProducts products{
      .square = 0.6, .radar_lidar = 0, .radar_prediction = 0, .lidar_prediction = 0};
  EXPECT_EQ(conflict::DengSupport(products).radar, 1.0 / 3);
  EXPECT_EQ(conflict::MutualSupport(products).lidar, 1.0 / 3);
}

TEST(SupportTest, MutualSupportOfEqualBodiesIsAThirdEach) {
  const conflict::BeliefProducts products{
      .square = 0.6, .radar_lidar = 0.6, .radar_prediction = 0.6, .lidar_prediction = 0.6};
  EXPECT_NEAR(conflict::MutualSupport(products).radar, 1.0 / 3, kEven);
  EXPECT_NEAR(conflict::DengSupport(products).radar, 1.0 / 3, kEven);
  EXPECT_NEAR(conflict::MurphySupport(products).radar, 1, kEven);
}

}  // namespace
}  // namespace fogline
