// Every number of a scenario has a source that a person can read.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "scenario/sections/scenario.h"

namespace fogline {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct NumberField {
  std::string pointer;
  std::string source;
};

/// Collects every numeric field that it visits.
class NumberCollector {
 public:
  NumberCollector(std::vector<NumberField>& numbers, std::string pointer)
      : numbers_(numbers), pointer_(std::move(pointer)) {}

  void Number(std::string_view name, const double&, const NumberSpec& spec) {
    numbers_.push_back({Pointer(name), std::string(spec.source)});
  }
  void Integer(std::string_view name, const std::int64_t&, const IntegerSpec& spec) {
    numbers_.push_back({Pointer(name), std::string(spec.source)});
  }
  void Numbers(std::string_view name, const std::vector<double>&, const NumberSpec& spec,
               const ListSpec&) {
    numbers_.push_back({Pointer(name), std::string(spec.source)});
    numbers_.push_back({Pointer(name) + "/*", std::string(spec.source)});
  }
  void Flag(std::string_view, const bool&, std::string_view) {}
  void Text(std::string_view, const std::string&, std::string_view) {}
  template <class Enum>
  void Choice(std::string_view, const Enum&, std::string_view) {}
  template <class T>
  void Section(std::string_view name, const T& section, std::string_view) {
    NumberCollector inner(numbers_, Pointer(name));
    T::Fields(section, inner);
  }
  template <class T>
  void List(std::string_view name, const std::vector<T>&, const ListSpec&) {
    Section(fmt::format("{}/*", name), T{}, "");
  }
  void Needs(const NeedSpec&) {}

 private:
  std::string Pointer(std::string_view name) const { return fmt::format("{}/{}", pointer_, name); }

  std::vector<NumberField>& numbers_;
  std::string pointer_;
};

std::vector<NumberField> AllNumbers() {
  std::vector<NumberField> numbers;
  NumberCollector collector(numbers, "");
  const Scenario scenario;
  Scenario::Fields(scenario, collector);
  return numbers;
}

TEST(SourcesTest, AreInTheExplanationOfEveryNumber) {
  const std::vector<NumberField> numbers = AllNumbers();
  EXPECT_GE(numbers.size(), 200U);
  for (const NumberField& number : numbers) {
    EXPECT_NE(number.source, "") << number.pointer;
    EXPECT_THAT(ExplainField(number.pointer), HasSubstr("\n  Source:  " + number.source + "\n"));
  }
}

TEST(SourcesTest, GiveAReasonWhereTheNumberIsOurChoice) {
  for (const NumberField& number : AllNumbers()) {
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
