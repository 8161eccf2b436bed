#include "services/log/gaps/log_gaps.h"

#include <gtest/gtest.h>

namespace fogline::log {
namespace {

std::bitset<kNumChannels> Channels(std::initializer_list<std::size_t> channels) {
  std::bitset<kNumChannels> set;
  for (const std::size_t channel : channels) set.set(channel);
  return set;
}

TEST(LogGapsTest, JoinSuccessiveStepsThatLackTheSame) {
  LogGaps gaps;
  for (const std::int64_t step : {5, 6, 7, 9}) gaps.Add(step, Channels({IndexOf<radar_t>()}));
  gaps.Add(10, Channels({IndexOf<radar_t>(), IndexOf<lidar_t>()}));
  ASSERT_EQ(gaps.gaps.size(), 3U);
  EXPECT_EQ(gaps.gaps[0].Text(), "steps 5 to 7 lack RADAR");
  EXPECT_EQ(gaps.gaps[2].Text(), "step 10 lacks RADAR, LIDAR");
  EXPECT_EQ(gaps.Messages(), 6);
  EXPECT_EQ(gaps.Text(),
            "6 messages of 5 steps are missing (RADAR 5, LIDAR 1), first: steps 5 to 7 lack RADAR");
}

TEST(LogGapsTest, RememberALimitedNumberOfGaps) {
  LogGaps gaps;
  for (std::int64_t i = 0; i < 2 * static_cast<std::int64_t>(LogGaps::kMostGaps); ++i) {
    gaps.Add(2 * i, Channels({IndexOf<radar_t>()}));
  }
  EXPECT_EQ(gaps.gaps.size(), LogGaps::kMostGaps);
  EXPECT_EQ(gaps.left_out, static_cast<std::int64_t>(LogGaps::kMostGaps));
  EXPECT_EQ(gaps.messages[IndexOf<radar_t>()], 2 * static_cast<std::int64_t>(LogGaps::kMostGaps));
}

}  // namespace
}  // namespace fogline::log
