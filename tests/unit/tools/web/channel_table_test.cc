#include "tools/web/channel_table.h"

#include <gtest/gtest.h>

#include <vector>

#include "services/graph.h"

namespace fogline::web {
namespace {

const std::vector<std::uint8_t> kNoise(40, 1);

TEST(ChannelTableTest, GivesTheChannelsOfTheGraphTheirPlaces) {
  ChannelTable table;
  for (std::size_t place = 0; place < kNumChannels; ++place) {
    EXPECT_EQ(table.IdOf(kChannels[place].name, kNoise), place);
  }
  EXPECT_TRUE(table.others().empty());
}

TEST(ChannelTableTest, NumbersOtherChannelsAsTheyAreHeard) {
  ChannelTable table;
  std::vector<std::uint8_t> radar;
  runtime::Encode(radar_t{}, radar);
  EXPECT_EQ(table.IdOf("CAMERA", kNoise), kNumChannels);
  EXPECT_EQ(table.IdOf("MY_RADAR", radar), kNumChannels + 1);
  EXPECT_EQ(table.IdOf("CAMERA", radar), kNumChannels);
  ASSERT_EQ(table.others().size(), 2U);
  EXPECT_EQ(table.others()[0].type, "");
  EXPECT_EQ(table.others()[1].type, "radar_t");
}

TEST(ChannelTableTest, TakesALimitedNumberOfNames) {
  ChannelTable table;
  for (std::size_t i = 0; i < ChannelTable::kMostOthers; ++i) {
    EXPECT_TRUE(table.IdOf("C" + std::to_string(i), kNoise));
  }
  EXPECT_FALSE(table.IdOf("ONE_MORE", kNoise));
  EXPECT_TRUE(table.IdOf("C7", kNoise));
  EXPECT_TRUE(table.IdOf("TRUTH", kNoise));
}

}  // namespace
}  // namespace fogline::web
