// For property tests: fills a scenario with random values, and lists every value.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "scenario/sections/field_view.h"

namespace fogline {

/// Random values in a sequence that is the same on all systems. The sequences of std::
/// distributions differ between systems.
class ValueDraw {
 public:
  explicit ValueDraw(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in 0 to n - 1 (with a bias below 2^-40 for small n). @pre n > 0
  std::size_t Below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }

  /// A number in [min, max] of any magnitude: an end of the range, a round number, zero of either
  /// sign, a tiny number, or another number.
  double Number(double min, double max) {
    const double share = static_cast<double>(engine_() >> 11U) * 0x1p-53;
    double value = min + (max - min) * share;
    switch (Below(8)) {
      case 0:
        value = min;
        break;
      case 1:
        value = max;
        break;
      case 2:
        value = std::round(value);
        break;
      case 3:
        value = -0.0;
        break;
      case 4:
        value = std::ldexp(share, -static_cast<int>(Below(1070)));
        break;
      default:
        break;
    }
    return value >= min && value <= max ? value : min;
  }
  std::int64_t Integer(std::int64_t min, std::int64_t max) {
    const auto count = static_cast<std::size_t>(max - min) + 1;
    const std::size_t choice = Below(4);
    if (choice == 0) return min;
    if (choice == 1) return max;
    return min + static_cast<std::int64_t>(Below(count));
  }

 private:
  std::mt19937_64 engine_;
};

/// Gives a field a random value within its range; a section or a list of sections gets random
/// contents.
class RandomFiller {
 public:
  explicit RandomFiller(ValueDraw& draw) : draw_(draw) {}

  void operator()(const NumberField& number) {
    *number.value = draw_.Number(number.spec.min, number.spec.max);
  }
  void operator()(const IntegerField& integer) {
    *integer.value = draw_.Integer(integer.spec.min, integer.spec.max);
  }
  void operator()(bool* flag) { *flag = draw_.Below(2) == 1; }
  void operator()(std::string* text) {
    static constexpr std::string_view kPieces[] = {"fog", " ",  "\"",       "\\",
                                                   "/",   "~1", "\xc3\xa4", "\xf0\x9f\x8c\xab"};
    text->clear();
    for (std::size_t n = draw_.Below(12); n > 0; --n) *text += kPieces[draw_.Below(8)];
  }
  void operator()(const ChoiceField& choice) { choice.set(draw_.Below(choice.names.size())); }
  void operator()(const NumbersField& numbers) {
    numbers.values->resize(draw_.Below(40));
    for (double& value : *numbers.values) {
      value = draw_.Number(numbers.spec.min, numbers.spec.max);
    }
  }
  void operator()(const TextsField& texts) {
    texts.values->resize(draw_.Below(4));
    for (std::string& text : *texts.values) (*this)(&text);
  }
  void operator()(const ListField& list) {
    list.reset(draw_.Below(5));
    Fill(list.items(""));
  }
  void operator()(const SectionField& section) { Fill(section.fields("")); }

  void Fill(const FieldList& fields) {
    for (const Field& field : fields) std::visit(*this, field.value);
  }

 private:
  ValueDraw& draw_;
};

inline Scenario RandomScenario(ValueDraw& draw) {
  Scenario scenario;
  RandomFiller(draw).Fill(FieldsOf(scenario));
  if (scenario.lead.profile == LeadProfile::kRecorded) {
    scenario.lead.recorded.speeds_mps.push_back(draw.Number(0, 70));
  }
  if (scenario.lead.profile == LeadProfile::kSumo) scenario.lead.sumo.net.emplace_back("<net/>");
  return scenario;
}

/// The JSON pointer of every field, and its value as a text. Texts are equal only for equal values,
/// because the text of a double shows all its bits.
inline std::vector<std::pair<std::string, std::string>> Flatten(Scenario scenario) {
  struct Text {
    std::string operator()(const NumberField& number) const {
      return std::to_string(std::bit_cast<std::uint64_t>(*number.value));
    }
    std::string operator()(const IntegerField& integer) const {
      return std::to_string(*integer.value);
    }
    std::string operator()(const bool* flag) const { return *flag ? "true" : "false"; }
    std::string operator()(const std::string* text) const { return *text; }
    std::string operator()(const ChoiceField& choice) const { return std::to_string(choice.get()); }
    std::string operator()(const NumbersField&) const { return "numbers"; }
    std::string operator()(const TextsField&) const { return "texts"; }
    std::string operator()(const ListField&) const { return "a list"; }
    std::string operator()(const SectionField&) const { return "a section"; }
  };
  std::vector<std::pair<std::string, std::string>> flat;
  for (const Field& field : AllFields(scenario)) {
    flat.emplace_back(field.pointer, std::visit(Text(), field.value));
  }
  return flat;
}

}  // namespace fogline
