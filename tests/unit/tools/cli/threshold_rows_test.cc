#include "tools/cli/threshold_rows.h"

#include <gtest/gtest.h>

#include <vector>

#include "common/interrupt.h"
#include "tests/unit/tools/short_run.h"

namespace fogline::test {
namespace {

TEST(ThresholdRowsTest, AreThoseOfOneCore) {
  const Scenario scenario = Paper(200);
  const std::vector<double> thresholds{0.3, 0.9};
  const sweep::SeedRange seeds{.first = 3, .last = 6};
  const auto rows = cli::RowsInMemory(scenario, thresholds, seeds);
  const auto expected =
      sweep::SweepThresholds(scenario, thresholds, seeds, 1, [](std::int64_t) { return true; });
  ASSERT_EQ(rows.size(), 2U);
  ASSERT_EQ(expected.size(), 2U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].threshold, thresholds[i]);
    EXPECT_EQ(rows[i].rhe_pct.count(), 4);
    EXPECT_EQ(rows[i].si_pct.mean(), expected[i].si_pct.mean());
    EXPECT_EQ(rows[i].rhe_pct.mean(), expected[i].rhe_pct.mean());
    EXPECT_EQ(rows[i].collisions, expected[i].collisions);
  }
}

TEST(ThresholdRowsTest, AreGivenUpAfterAnInterrupt) {
  internal::interrupts = 1;
  EXPECT_THROW(cli::RowsInMemory(Paper(10), std::vector{0.5}, {.first = 1, .last = 1}),
               Interrupted);
  internal::interrupts = 0;
}

}  // namespace
}  // namespace fogline::test
