#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
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

// Makes the text of a field's value for an override (POINTER=TEXT). The text of a list of sections
// is a list of empty sections; further overrides set the fields of these sections. A section has no
// override of its own.
struct OverrideValue {
  std::string operator()(const NumberField& number) const { return NumberText(*number.value); }
  std::string operator()(const IntegerField& integer) const {
    return std::to_string(*integer.value);
  }
  std::string operator()(const bool* flag) const { return *flag ? "true" : "false"; }
  std::string operator()(const std::string* text) const { return Quote(*text); }
  std::string operator()(const ChoiceField& choice) const {
    return std::string(choice.names[choice.get()]);
  }
  std::string operator()(const NumbersField& numbers) const {
    std::string list;
    for (const double value : *numbers.values)
      list += (list.empty() ? "" : ",") + NumberText(value);
    return "[" + list + "]";
  }
  std::string operator()(const TextsField& texts) const {
    std::string list;
    for (const std::string& text : *texts.values) list += (list.empty() ? "" : ",") + Quote(text);
    return "[" + list + "]";
  }
  std::string operator()(const ListField& sections) const {
    std::string list;
    for (std::size_t i = 0; i < sections.items("").size(); ++i) list += list.empty() ? "{}" : ",{}";
    return "[" + list + "]";
  }
  std::string operator()(const SectionField&) const { return ""; }
};

std::vector<std::string> OverridesOf(Scenario scenario) {
  std::vector<std::string> overrides;
  for (const Field& field : AllFields(scenario)) {
    if (field.As<SectionField>() != nullptr) continue;
    overrides.push_back(field.pointer + "=" + std::visit(OverrideValue(), field.value));
  }
  return overrides;
}

TEST(OverrideProperty, OverridingEveryFieldMakesAnyScenarioOfAnyOther) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    ValueDraw draw(seed);
    const std::string from = PrintScenario(RandomScenario(draw));
    const Scenario to = RandomScenario(draw);
    const std::vector<std::string> overrides = OverridesOf(to);
    ASSERT_EQ(Flatten(ParseScenario(from, "f", overrides)), Flatten(to)) << "seed " << seed;
    ASSERT_EQ(Flatten(ParseScenario(R"({"version": 1})", "f", overrides)), Flatten(to))
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace fogline
