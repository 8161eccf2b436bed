#include "services/decision/conflict/over_time/doc.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {
namespace {

constexpr double kSlope_pm = 10;
constexpr double kCentre_m = 1;

// The conflict z, in m, that has this DoC.
double ConflictOf(double doc) { return kCentre_m + std::log(doc / (1 - doc)) / kSlope_pm; }

TEST(DocTest, HasTheTabulatedValues) {
  constexpr std::array<std::pair<double, double>, 7> kTable{
      {{0, .00005}, {.8, .119}, {.9, .269}, {1, .5}, {1.1, .731}, {1.22, .9}, {1.5, .993}}};
  for (const auto& [z, doc] : kTable) {
    conflict::Doc measure({});
    EXPECT_NEAR(measure.Step(LidarShortBy(z)), doc, z == 0 ? 5e-6 : 5e-4) << "z = " << z;
  }
}

TEST(DocTest, MeanAndVarianceOfItsConflictWithoutFaultAreTheQuotedOnes) {
  constexpr double kStd_m = 0.4;  // of the difference radar - LiDAR
  constexpr int kWindow = 8;
  constexpr int kWindows = 4000;
  const Random random(2, Stream::kRadar);
  conflict::Doc measure({});
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kWindows; ++i) {
    double doc = 0;
    for (int step = i * kWindow; step < (i + 1) * kWindow; ++step) {
      doc = measure.Step(LidarShortBy(kStd_m * random.Normal2(step, 0)[0]));
    }
    sum += ConflictOf(doc);
    squares += ConflictOf(doc) * ConflictOf(doc);
  }
  const double mean = sum / kWindows;
  const double variance = squares / kWindows - mean * mean;
  const double expected_mean = kStd_m * std::sqrt(2 / std::numbers::pi);
  const double expected_variance = kStd_m * kStd_m * (1 - 2 / std::numbers::pi) / kWindow;
  EXPECT_NEAR(expected_mean, 0.32, 5e-3);
  EXPECT_NEAR(mean, expected_mean, 4 * std::sqrt(expected_variance / kWindows));
  // The variance of n nearly normal numbers has a relative standard deviation of sqrt(2/n).
  EXPECT_NEAR(variance, expected_variance, 4 * expected_variance * std::sqrt(2.0 / kWindows));
}

TEST(DocTest, AStepBiasCrossesTheCentreAfterTheQuotedShareOfTheWindow) {
  // In a window of N steps with the conflict z0 = 0.32 m, a bias b raises the conflict to the
  // centre of 1 m after n = N (1 m - z0)/(b - z0) steps: N/14 for a bias of 10 m, 0.6 N for 1.5 m.
  constexpr int kWindow = 140;
  constexpr double kFloor_m = 0.32;
  for (const auto& [bias_m, share] : {std::pair{10.0, 1.0 / 14}, std::pair{1.5, 0.6}}) {
    conflict::ConflictParameters parameters;
    parameters.window_steps = kWindow;
    conflict::Doc measure(parameters);
    for (int i = 0; i < kWindow; ++i) measure.Step(LidarShortBy(kFloor_m));
    int steps = 1;
    while (measure.Step(LidarShortBy(bias_m)) < 0.5) ++steps;
    EXPECT_NEAR(steps, kWindow * share, 0.03 * kWindow) << bias_m;  // 0.6 is 0.576, rounded
  }
}

TEST(DocTest, ForgetsItsWholeWindowInReset) {
  conflict::Doc measure({});
  for (int i = 0; i < 8; ++i) measure.Step(LidarShortBy(2));
  measure.Reset();
  EXPECT_EQ(measure.Step(LidarShortBy(1)), 0.5);
}

TEST(DocTest, KeepsTheOffsetThatOtherMeasuresTakeOff) {
  conflict::ConflictParameters parameters;
  parameters.offset_m = 1;
  conflict::Doc measure(parameters);
  EXPECT_EQ(measure.Step(LidarShortBy(1)), 0.5);
}

TEST(DocTest, DropoutsLookLikeAgreementOnlyWhereTheyAreSkipped) {
  constexpr int kWindow = 8;
  const auto after_dropouts = [](MissingLidar rule) {
    conflict::ConflictParameters parameters;
    parameters.missing = rule;
    conflict::Doc measure(parameters);
    double doc = measure.Step(LidarShortBy(1));
    for (int i = 0; i < kWindow; ++i) doc = measure.Step(WithoutLidar(LidarShortBy(1)));
    return doc;
  };
  EXPECT_EQ(after_dropouts(MissingLidar::kHold), 0.5);
  EXPECT_LT(after_dropouts(MissingLidar::kSkip), 1e-4);
  EXPECT_GT(after_dropouts(MissingLidar::kConflict), 1 - 1e-12);
}

}  // namespace
}  // namespace fogline
