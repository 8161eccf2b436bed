#include "services/metrics/gaps/holes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fogline::metrics {
namespace {

std::vector<Sample> SamplesAt(const std::vector<std::int64_t>& steps) {
  std::vector<Sample> samples;
  for (const std::int64_t step : steps) {
    samples.push_back({.step = step, .time_s = 0.1 * static_cast<double>(step), .host_gap_m = 30});
  }
  return samples;
}

TEST(HolesTest, AGapOfAnyLengthHasOneSampleWithoutValues) {
  const std::vector<Sample> samples = WithHoles(SamplesAt({3, 4, 6, 20}), 0.1);
  ASSERT_EQ(samples.size(), 6U);
  for (const std::size_t hole : {2U, 4U}) {
    EXPECT_TRUE(std::isnan(samples[hole].host_gap_m));
    EXPECT_TRUE(std::isnan(samples[hole].fog_visibility_m));
    EXPECT_EQ(samples[hole].step, samples[hole - 1].step + 1);
    EXPECT_DOUBLE_EQ(samples[hole].time_s, 0.1 * static_cast<double>(samples[hole].step));
  }
  for (const std::size_t whole : {0U, 1U, 3U, 5U}) EXPECT_EQ(samples[whole].host_gap_m, 30);
}

TEST(HolesTest, SamplesOfEveryStepStayAsTheyAre) {
  EXPECT_EQ(WithHoles(SamplesAt({0, 1, 2}), 0.1).size(), 3U);
  EXPECT_TRUE(WithHoles({}, 0.1).empty());
}

}  // namespace
}  // namespace fogline::metrics
