// Tests that every number of a scenario names its source (a paper, or our choice with a reason),
// and that the explanation of the field shows the source.
#include <cstddef>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/io/catalogue.h"
#include "scenario/io/loader.h"

namespace fogline {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// All fields of a scenario that are a number or a list of numbers. In Catalogue() each list of
/// sections has one item, so the result has the fields of this item.
std::vector<Field> AllNumbers() {
  std::vector<Field> numbers;
  for (const Field& field : Catalogue()) {
    if (field.As<NumberField>() || field.As<IntegerField>() || field.As<NumbersField>()) {
      numbers.push_back(field);
    }
  }
  return numbers;
}

TEST(SourcesTest, AreInTheExplanationOfEveryNumber) {
  const std::vector<Field> numbers = AllNumbers();
  EXPECT_GE(numbers.size(), 200U);
  for (const Field& number : numbers) {
    EXPECT_NE(number.source, "") << number.pointer;
    EXPECT_THAT(ExplainField(number.pointer),
                HasSubstr(fmt::format("\n  Source:  {}\n", number.source)));
  }
}

TEST(SourcesTest, GiveAReasonWhereTheNumberIsOurChoice) {
  for (const Field& number : AllNumbers()) {
    SCOPED_TRACE(number.pointer);
    for (const char* bare : {"chosen", "estimate", "guess", "our choice"}) {
      const std::size_t at = number.source.find(bare);
      if (at == std::string::npos) continue;
      EXPECT_EQ(at, 0U) << number.source;
      EXPECT_THAT(number.source, StartsWith("our choice, because "));
    }
    EXPECT_FALSE(number.source.ends_with('.')) << "the explanation and the schema end it";
  }
}

}  // namespace
}  // namespace fogline
