#include "tools/processes/last_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline {
namespace {

using testing::ElementsAre;

TEST(LastLinesTest, PutPiecesTogetherAndEndWithWhatHasNoLineFeed) {
  processes::LastLines lines;
  for (const char* piece : {"a", "b\n", "\nc\nd", "e"}) lines.Append(piece);
  EXPECT_THAT(lines.Take(), ElementsAre("ab", "", "c", "de"));
}

TEST(LastLinesTest, AreTheLastOfMany) {
  processes::LastLines lines;
  for (int i = 0; i < 1000; ++i) lines.Append(std::to_string(i) + "\n");
  const auto taken = lines.Take();
  ASSERT_EQ(taken.size(), processes::LastLines::kKept);
  EXPECT_EQ(taken.front(), "990");
  EXPECT_EQ(taken.back(), "999");
}

TEST(LastLinesTest, KeepTheBeginningOfALineWithoutEnd) {
  processes::LastLines lines;
  const std::string piece(1000, 'x');
  lines.Append("begins ");
  for (int i = 0; i < 10'000; ++i) lines.Append(piece);
  lines.Append("\nnext\n");
  const auto taken = lines.Take();
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[0].size(), processes::LastLines::kMaxBytes);
  EXPECT_TRUE(taken[0].starts_with("begins xxx"));
  EXPECT_EQ(taken[1], "next");
}

}  // namespace
}  // namespace fogline
