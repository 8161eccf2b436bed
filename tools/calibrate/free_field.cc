#include "tools/calibrate/free_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/parse_number.h"
#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "scenario/sections/field_text.h"
#include "scenario/sections/field_view.h"

namespace fogline::calibrate {
namespace {

constexpr std::string_view kForm =
    "neither /pointer=lowest:highest nor /pointer=lowest:highest:log";
// Digits to which a value is rounded. A linear range has at least 10^5 rounded values.
constexpr int kLinearDigits = 5;
constexpr int kLogarithmicDigits = 6;

[[noreturn]] void Refuse(const std::string& text, std::string_view why) {
  throw InputError(fmt::format("error: --free {}: {}", Shown(text), why));
}

std::optional<double> ParseFinite(std::string_view text) {
  const auto number = ParseNumber<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

/// Value, bounds and unit of a number or integer field of a scenario.
struct NumericField {
  double value;
  double min;
  double max;
  bool is_integer;
  std::string_view unit;
  std::string range;
};

std::optional<NumericField> Find(Scenario scenario, std::string_view pointer) {
  const std::optional<Field> field = FieldAt(scenario, pointer);
  if (!field || field->name.empty()) return std::nullopt;
  if (const auto* number = field->As<NumberField>()) {
    const NumberSpec& spec = number->spec;
    return NumericField{*number->value, spec.min, spec.max, false, spec.unit, Range(spec)};
  }
  if (const auto* integer = field->As<IntegerField>()) {
    const IntegerSpec& spec = integer->spec;
    return NumericField{static_cast<double>(*integer->value),
                        static_cast<double>(spec.min),
                        static_cast<double>(spec.max),
                        true,
                        spec.unit,
                        Range(spec)};
  }
  return std::nullopt;
}

}  // namespace

FreeField::Parts FreeField::Split(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (!text.starts_with('/') || equals == std::string::npos) Refuse(text, kForm);
  Parts parts{
      .pointer = text.substr(0, equals), .lowest = 0, .highest = 0, .is_logarithmic = false};
  std::string_view bounds = std::string_view(text).substr(equals + 1);
  constexpr std::string_view kLogarithmic = ":log";
  if (bounds.ends_with(kLogarithmic)) {
    parts.is_logarithmic = true;
    bounds.remove_suffix(kLogarithmic.size());
  }
  const std::size_t colon = bounds.find(':');
  if (colon == std::string_view::npos) Refuse(text, kForm);
  const auto lowest = ParseFinite(bounds.substr(0, colon));
  const auto highest = ParseFinite(bounds.substr(colon + 1));
  if (!lowest || !highest) Refuse(text, kForm);
  parts.lowest = *lowest;
  parts.highest = *highest;
  if (FindField(parts.pointer) == nullptr) {
    Refuse(text, "no such field" + DidYouMean(SuggestPointer(parts.pointer)));
  }
  if (parts.pointer == "/seed") Refuse(text, "seeds are given by --seeds");
  if (parts.pointer == "/arbitrator/threshold") Refuse(text, "the thresholds are the target's");
  if (!Find(Scenario(), parts.pointer)) {
    Refuse(text, "neither a number nor an integer outside lists");
  }
  return parts;
}

FreeField::FreeField(const std::string& text) : FreeField(text, Split(text)) {}

FreeField::FreeField(const std::string& text, const Parts& parts)
    : assignment_(parts.pointer),
      lowest_(parts.lowest),
      highest_(parts.highest),
      is_logarithmic_(parts.is_logarithmic) {
  const NumericField field = *Find(Scenario(), parts.pointer);
  for (const double bound : {lowest_, highest_}) {
    if (bound < field.min || bound > field.max) {
      Refuse(text, fmt::format("{} is outside {}", NumberText(bound), field.range));
    }
    if (field.is_integer && bound != std::trunc(bound)) {
      Refuse(text, fmt::format("{} is no integer", NumberText(bound)));
    }
  }
  if (lowest_ >= highest_) {
    Refuse(text, fmt::format("{} is not below {}", NumberText(lowest_), NumberText(highest_)));
  }
  if (is_logarithmic_ && lowest_ <= 0) {
    Refuse(text, "a logarithmic scale needs bounds above 0");
  }
  is_integer_ = field.is_integer;
  unit_ = field.unit;
}

double FreeField::ValueAt(double share) const {
  share = std::clamp(share, 0.0, 1.0);
  const double exact = is_logarithmic_ ? lowest_ * std::pow(highest_ / lowest_, share)
                                       : lowest_ + share * (highest_ - lowest_);
  if (is_integer_) return std::clamp(std::round(exact), lowest_, highest_);
  // Prints the number with few decimal digits and reads this text again. So the result always
  // prints as this short text.
  const int decimals = kLinearDigits - static_cast<int>(std::floor(std::log10(highest_ - lowest_)));
  const std::string rounded = is_logarithmic_
                                  ? fmt::format("{:.{}g}", exact, kLogarithmicDigits)
                                  : fmt::format("{:.{}f}", exact, std::max(0, decimals));
  return std::clamp(*ParseFinite(rounded), lowest_, highest_);
}

double FreeField::ShareOf(double value) const {
  value = std::clamp(value, lowest_, highest_);
  return is_logarithmic_ ? std::log(value / lowest_) / std::log(highest_ / lowest_)
                         : (value - lowest_) / (highest_ - lowest_);
}

double FreeField::Get(const Scenario& scenario) const { return Find(scenario, pointer())->value; }

std::vector<FreeField> ParseFreeFields(const std::vector<std::string>& texts) {
  std::vector<FreeField> fields;
  for (const std::string& text : texts) {
    const FreeField& field = fields.emplace_back(text);
    for (std::size_t i = 0; i + 1 < fields.size(); ++i) {
      if (fields[i].pointer() == field.pointer()) Refuse(text, "given twice");
    }
  }
  return fields;
}

}  // namespace fogline::calibrate
