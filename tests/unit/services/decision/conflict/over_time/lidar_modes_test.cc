#include "services/decision/conflict/over_time/lidar_modes.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {
namespace {

conflict::Evidence At(double car_m, double lidar_m) {
  return {.radar = {true, car_m, 0.1},
          .lidar = {true, lidar_m, 0.05},
          .prediction = {true, car_m, 0.1}};
}

double Of(const conflict::LidarModes::Probabilities& probabilities, conflict::LidarMode mode) {
  return probabilities[static_cast<std::size_t>(mode)];
}

TEST(LidarModesTest, OneStepIsBayesRuleWorkedByHand) {
  conflict::ConflictParameters parameters;
  conflict::LidarModes modes(parameters);
  // GIVEN: a clean LiDAR, WHEN: there is no echo
  const auto& posterior = modes.Step(WithoutLidar(At(30, 30)));
  // THEN: the modes clean, fog return and dropout have the predicted probabilities (.99, .005,
  // .005), and in these modes "no echo" has the likelihoods (.02, .1, .98)
  const double sum = .99 * .02 + .005 * .1 + .005 * .98;
  EXPECT_NEAR(Of(posterior, conflict::LidarMode::kClean), .99 * .02 / sum, 1e-12);
  EXPECT_NEAR(Of(posterior, conflict::LidarMode::kFogReturn), .005 * .1 / sum, 1e-12);
  EXPECT_NEAR(Of(posterior, conflict::LidarMode::kDropout), .005 * .98 / sum, 1e-12);
}

TEST(LidarModesTest, FogIsLikeliestAtTheMeanOfItsScatter) {
  // GIVEN: an echo at the mean distance of the fog's echoes, r* + 10 m E[Beta(2, 20)] with r* = 3.5
  // m. The clean mode cannot produce this echo.
  const double fog_m = 3.5 + 10 * 2.0 / 22;
  conflict::LidarModes modes({});
  const auto& posterior = modes.Step(At(200, fog_m));
  // THEN: the odds of fog to dropout follow from Var[Beta(2, 20)] = 40/(22^2 23) and a LiDAR noise
  // of 0.05 m
  const double variance = 0.05 * 0.05 + 100 * 40.0 / (22 * 22 * 23);
  const double fog = 0.9 * (0.9 / std::sqrt(2 * std::numbers::pi * variance) + 0.1 / 250);
  EXPECT_NEAR(Of(posterior, conflict::LidarMode::kDropout), 0.02 / 250 / (0.02 / 250 + fog), 1e-12);
}

TEST(LidarModesTest, AnEchoAtTheCarIsClean) {
  conflict::LidarModeConflict measure({});
  double score = 1;
  for (int i = 0; i < 10; ++i) score = measure.Step(At(30, 30.05));
  EXPECT_LT(score, 1e-3);
}

TEST(LidarModesTest, AnEchoInTheNearFieldIsFogInTheFirstStep) {
  conflict::LidarModes modes({});
  EXPECT_GT(Of(modes.Step(At(30, 4.3)), conflict::LidarMode::kFogReturn), 0.99);
}

TEST(LidarModesTest, NoEchoForSomeStepsIsADropout) {
  conflict::LidarModes modes({});
  for (int i = 0; i < 4; ++i) modes.Step(WithoutLidar(At(30, 30)));
  EXPECT_GT(Of(modes.Step(WithoutLidar(At(30, 30))), conflict::LidarMode::kDropout), 0.9);
}

TEST(LidarModesTest, AMixtureOfCarAndFogIsNotClean) {
  conflict::LidarModeConflict measure({});
  EXPECT_GT(measure.Step(At(30, 28)), 0.99);
}

TEST(LidarModesTest, TakesThePredictionWhereTheRadarHasNoValue) {
  conflict::LidarModeConflict measure({});
  EXPECT_GT(measure.Step(WithoutRadar(At(30, 4.3))), 0.99);
}

TEST(LidarModesTest, ThePredictionHasNotTheOffsetOfTheRadar) {
  const auto score = [](double lidar_m) {
    conflict::LidarModeConflict measure({.offset_m = 2});
    return measure.Step(WithoutRadar(At(30, lidar_m)));
  };
  EXPECT_LT(score(30), 0.05);
  EXPECT_GT(score(28), 0.99);
}

TEST(LidarModesTest, AnEchoWithoutAnyReferenceSaysNothing) {
  conflict::LidarModes modes({});
  conflict::Evidence alone = WithoutRadar(At(30, 4.3));
  alone.prediction.valid = false;
  EXPECT_NEAR(Of(modes.Step(alone), conflict::LidarMode::kClean), 0.99,
              1e-12);  // only the Markov chain's transition has an effect
}

TEST(LidarModesTest, ComesBackFromFogWithinASecond) {
  conflict::LidarModeConflict measure({});
  for (int i = 0; i < 100; ++i) measure.Step(At(30, 4.3));
  double score = 1;
  for (int i = 0; i < 10; ++i) score = measure.Step(At(30, 30));
  EXPECT_LT(score, 1e-3);
}

TEST(LidarModesTest, ProbabilitiesAddUpToOneWhateverComes) {
  const Random random(5, Stream::kLidar);
  conflict::LidarModes modes({});
  for (int step = 0; step < 2000; ++step) {
    const auto& posterior = modes.Step(Anything(random, step));
    ASSERT_NEAR(std::accumulate(posterior.begin(), posterior.end(), 0.0), 1, 1e-12) << step;
  }
}

TEST(LidarModesTest, NeverBlamesTheRadar) {
  conflict::LidarModeBlame blame({});
  const conflict::Blame of_long_radar = blame.Step(RadarLongBy(20));
  EXPECT_EQ(of_long_radar.radar, 0);
}

}  // namespace
}  // namespace fogline
