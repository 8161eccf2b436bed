#include "tools/study/study_findings.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(DifferenceTextTest, SaysMoreLessOrUndecided) {
  EXPECT_EQ(study::DifferenceText({.n = 9, .mean = 1.5, .deviation = 1, .low = 1, .high = 2},
                                  "points", 1, " than before"),
            "1.5 [1.0, 2.0] points more than before");
  EXPECT_EQ(
      study::DifferenceText({.n = 9, .mean = -1.5, .deviation = 1, .low = -2, .high = -1}, "m", 1),
      "1.5 [1.0, 2.0] m less");
  EXPECT_EQ(study::DifferenceText({.n = 9, .mean = -0.5, .deviation = 1, .low = -1.5, .high = 0.5},
                                  "m", 1),
            "0.5 [−0.5, 1.5] m less, which is not significant in 9 pairs of runs");
}

TEST(DifferenceTextTest, SaysWhenThereAreTooFewRuns) {
  EXPECT_EQ(study::DifferenceText({.n = 1, .mean = 2}, "points", 1),
            "2.0 points more, with too few runs for an interval");
  EXPECT_EQ(study::DifferenceText({}, "m", 1), "without a pair of runs to compare");
  EXPECT_EQ(study::DifferenceText({.infinite = 3}, "s", 1),
            "infinitely far apart in 3 pairs of runs");
}

TEST(ListTextTest, JoinsNames) {
  EXPECT_EQ(study::ListText({}), "");
  EXPECT_EQ(study::ListText({"a"}), "a");
  EXPECT_EQ(study::ListText({"a", "b", "c"}), "a, b and c");
}

TEST(ComparedMetricsTest, HasSafetyImprovementCollisionsAndEveryMeasureOfARun) {
  EXPECT_EQ(study::PlaceOfMetric("si_pct"), 0U);
  EXPECT_EQ(study::PlaceOfMetric("si_until_recovery_pct"), 1U);
  EXPECT_EQ(study::PlaceOfMetric("collided"), 2U);
  EXPECT_GT(study::PlaceOfMetric("max_handover_jerk_mps3"), 2U);
  EXPECT_THROW(study::PlaceOfMetric("levity"), std::out_of_range);
}

}  // namespace
}  // namespace fogline
