#include "common/csv.h"

#include <gtest/gtest.h>

namespace fogline {
namespace {

TEST(CsvCellTest, HasQuotesOnlyWhereACharacterRequiresThem) {
  EXPECT_EQ(CsvCell(""), "");
  EXPECT_EQ(CsvCell("a b; c"), "a b; c");
  EXPECT_EQ(CsvCell("a,b"), "\"a,b\"");
  EXPECT_EQ(CsvCell("say \"go\""), "\"say \"\"go\"\"\"");
  EXPECT_EQ(CsvCell("a\nb"), "\"a\nb\"");
  EXPECT_EQ(CsvCell("a\rb"), "\"a\rb\"");
}

}  // namespace
}  // namespace fogline
