#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/text.h"
#include "scenario/io/loader.h"
#include "tests/property/scenario/random_scenario.h"

namespace fogline {
namespace {

TEST(RoundTripProperty, PrintedScenariosReadBackBitByBit) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    ValueDraw draw(seed);
    const Scenario scenario = RandomScenario(draw);
    const std::string text = PrintScenario(scenario);
    const Scenario again = ParseScenario(text);
    ASSERT_EQ(Flatten(scenario), Flatten(again)) << "seed " << seed;
    ASSERT_EQ(text, PrintScenario(again)) << "seed " << seed;
  }
}

// Writes an override for each field of a scenario. For a list of sections, the first override makes
// a list of empty sections.
class OverrideWriter {
 public:
  void Number(std::string_view name, const double& value, const NumberSpec&) {
    Add(name, NumberText(value));
  }
  void Integer(std::string_view name, const std::int64_t& value, const IntegerSpec&) {
    Add(name, std::to_string(value));
  }
  void Flag(std::string_view name, const bool& value, std::string_view) {
    Add(name, value ? "true" : "false");
  }
  void Text(std::string_view name, const std::string& value, std::string_view) {
    Add(name, Quote(value));
  }
  template <class Enum>
  void Choice(std::string_view name, const Enum& value, std::string_view) {
    Add(name, std::string(ChoiceNames<Enum>::kNames[static_cast<std::size_t>(value)]));
  }
  void Numbers(std::string_view name, const std::vector<double>& values, const NumberSpec&,
               const ListSpec&) {
    std::string list;
    for (const double value : values) list += (list.empty() ? "" : ",") + NumberText(value);
    Add(name, "[" + list + "]");
  }
  template <class T>
  void Section(std::string_view name, const T& section, std::string_view) {
    const std::string outer = std::exchange(pointer_, pointer_ + "/" + std::string(name));
    T::Fields(section, *this);
    pointer_ = outer;
  }
  template <class T>
  void List(std::string_view name, const std::vector<T>& items, const ListSpec&) {
    std::string list;
    for (std::size_t i = 0; i < items.size(); ++i) list += list.empty() ? "{}" : ",{}";
    Add(name, "[" + list + "]");
    for (std::size_t i = 0; i < items.size(); ++i) {
      Section(std::string(name) + "/" + std::to_string(i), items[i], "");
    }
  }
  void Needs(const NeedSpec&) {}

  std::vector<std::string> overrides;

 private:
  void Add(std::string_view name, const std::string& value) {
    overrides.push_back(pointer_ + "/" + std::string(name) + "=" + value);
  }

  std::string pointer_;
};

TEST(OverrideProperty, OverridingEveryFieldMakesAnyScenarioOfAnyOther) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    ValueDraw draw(seed);
    const std::string from = PrintScenario(RandomScenario(draw));
    const Scenario to = RandomScenario(draw);
    OverrideWriter writer;
    Scenario::Fields(to, writer);
    ASSERT_EQ(Flatten(ParseScenario(from, "f", writer.overrides)), Flatten(to)) << "seed " << seed;
    ASSERT_EQ(Flatten(ParseScenario(R"({"version": 1})", "f", writer.overrides)), Flatten(to))
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace fogline
