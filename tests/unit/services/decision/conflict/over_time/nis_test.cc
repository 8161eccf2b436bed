#include "services/decision/conflict/over_time/nis.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/services/decision/conflict/evidence.h"

namespace fogline {
namespace {

TEST(SignedNisTest, IsTheMeanInUnitsOfItsStandardDeviation) {
  conflict::ConflictParameters parameters;
  parameters.window_steps = 4;
  conflict::SignedNis measure(parameters);
  double score = 0;
  for (const double d : {9.0, 1.0, 2.0, 3.0, 6.0}) score = measure.Step(LidarShortBy(d, 3, 4));
  EXPECT_NEAR(score, 3.0 * std::sqrt(4 / 25.0), 1e-12);  // mean 3 m, S = 25 m2, n = 4
}

TEST(SignedNisTest, IsStandardNormalWithoutAFault) {
  constexpr int kWindows = 5000;
  const Random random(7, Stream::kRadar);
  const int window = conflict::ConflictParameters{}.window_steps;
  conflict::SignedNis measure({});
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kWindows; ++i) {
    double score = 0;
    for (int step = i * window; step < (i + 1) * window; ++step) {
      score = measure.Step(UnitNoise(random, step));
    }
    sum += score;
    squares += score * score;
  }
  EXPECT_NEAR(sum / kWindows, 0, 4 / std::sqrt(kWindows));
  EXPECT_NEAR(squares / kWindows, 1, 4 * std::sqrt(2.0 / kWindows));
}

TEST(SignedNisTest, ALidarThatIsLongIsTheOppositeOfConflict) {
  conflict::SignedNis measure({});
  EXPECT_LT(measure.Step(LidarShortBy(-1)), 0);
}

TEST(WindowedNisTest, IsTheMeanOfTheSquares) {
  conflict::ConflictParameters parameters;
  parameters.window_steps = 2;
  conflict::WindowedNis measure(parameters);
  EXPECT_EQ(measure.Step(LidarShortBy(5, 3, 4)), 1);
  EXPECT_EQ(measure.Step(LidarShortBy(-10, 3, 4)), 2.5);
  EXPECT_EQ(measure.Step(LidarShortBy(0, 3, 4)), 2);
}

TEST(WindowedNisTest, AnEmptyPlaceAgesWhereMissingValuesAreSkipped) {
  conflict::ConflictParameters parameters;
  parameters.window_steps = 2;
  parameters.missing = MissingLidar::kSkip;
  conflict::WindowedNis measure(parameters);
  EXPECT_EQ(measure.Step(LidarShortBy(5, 3, 4)), 1);
  EXPECT_EQ(measure.Step(WithoutLidar(LidarShortBy(5))), 1);
  EXPECT_EQ(measure.Step(WithoutLidar(LidarShortBy(5))), 0);
}

}  // namespace
}  // namespace fogline
