// Visitors for property tests: one fills a scenario with random values, one lists every field.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/sections/scenario.h"

namespace fogline {

/// Random values in a sequence that is the same on all systems, unlike that of std:: distributions.
class ValueDraw {
 public:
  explicit ValueDraw(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in 0 to n - 1 (with a bias below 2^-40 for small n). @pre n > 0
  std::size_t Below(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }

  /// A number in [min, max] of any magnitude: an end, a round number, zero of either sign, a tiny
  /// number, or any other.
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

/// Gives every field a random value within its range.
class RandomFiller {
 public:
  explicit RandomFiller(ValueDraw& draw) : draw_(draw) {}

  void Number(std::string_view, double& value, const NumberSpec& spec) {
    value = draw_.Number(spec.min, spec.max);
  }
  void Integer(std::string_view, std::int64_t& value, const IntegerSpec& spec) {
    value = draw_.Integer(spec.min, spec.max);
  }
  void Flag(std::string_view, bool& value, std::string_view) { value = draw_.Below(2) == 1; }
  void Text(std::string_view, std::string& value, std::string_view) {
    static constexpr std::string_view kPieces[] = {"fog", " ",  "\"",       "\\",
                                                   "/",   "~1", "\xc3\xa4", "\xf0\x9f\x8c\xab"};
    value.clear();
    for (std::size_t n = draw_.Below(12); n > 0; --n) value += kPieces[draw_.Below(8)];
  }
  template <class Enum>
  void Choice(std::string_view, Enum& value, std::string_view) {
    value = static_cast<Enum>(draw_.Below(ChoiceNames<Enum>::kNames.size()));
  }
  void Numbers(std::string_view, std::vector<double>& values, const NumberSpec& spec,
               const ListSpec&) {
    values.resize(draw_.Below(40));
    for (double& value : values) value = draw_.Number(spec.min, spec.max);
  }
  template <class T>
  void Section(std::string_view, T& section, std::string_view) {
    T::Fields(section, *this);
  }
  template <class T>
  void List(std::string_view, std::vector<T>& items, const ListSpec&) {
    items.resize(draw_.Below(5));
    for (T& item : items) T::Fields(item, *this);
  }
  void Needs(const NeedSpec&) {}

 private:
  ValueDraw& draw_;
};

inline Scenario RandomScenario(ValueDraw& draw) {
  Scenario scenario;
  RandomFiller filler(draw);
  Scenario::Fields(scenario, filler);
  if (scenario.lead.profile == LeadProfile::kRecorded) {
    scenario.lead.recorded.speeds_mps.push_back(draw.Number(0, 70));
  }
  return scenario;
}

/// Lists every field as a pointer and the JSON text of its value, doubles with all their bits.
class Flattener {
 public:
  using Fields = std::vector<std::pair<std::string, std::string>>;

  void Number(std::string_view name, const double& value, const NumberSpec&) {
    Add(name, std::to_string(std::bit_cast<std::uint64_t>(value)));
  }
  void Integer(std::string_view name, const std::int64_t& value, const IntegerSpec&) {
    Add(name, std::to_string(value));
  }
  void Flag(std::string_view name, const bool& value, std::string_view) {
    Add(name, value ? "true" : "false");
  }
  void Text(std::string_view name, const std::string& value, std::string_view) { Add(name, value); }
  template <class Enum>
  void Choice(std::string_view name, const Enum& value, std::string_view) {
    Add(name, std::to_string(static_cast<int>(value)));
  }
  void Numbers(std::string_view name, const std::vector<double>& values, const NumberSpec& spec,
               const ListSpec&) {
    for (const double value : values) Number(name, value, spec);
  }
  template <class T>
  void Section(std::string_view name, const T& section, std::string_view) {
    const std::string outer = std::exchange(pointer_, pointer_ + "/" + std::string(name));
    T::Fields(section, *this);
    pointer_ = outer;
  }
  template <class T>
  void List(std::string_view name, const std::vector<T>& items, const ListSpec&) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      Section(std::string(name) + "/" + std::to_string(i), items[i], "");
    }
  }
  void Needs(const NeedSpec&) {}

  const Fields& fields() const { return fields_; }

 private:
  void Add(std::string_view name, std::string value) {
    fields_.emplace_back(pointer_ + "/" + std::string(name), std::move(value));
  }

  std::string pointer_;
  Fields fields_;
};

inline Flattener::Fields Flatten(const Scenario& scenario) {
  Flattener flattener;
  Scenario::Fields(scenario, flattener);
  return flattener.fields();
}

}  // namespace fogline
