#include "scenario/io/assignment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <variant>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/parse_number.h"
#include "scenario/io/catalogue.h"

namespace fogline {
namespace {

/// A value for a field, as a text, as a number, or both.
struct Value {
  std::optional<double> number;
  std::string_view text;
};

/// Gives a field the value; returns false if the field cannot have this value.
struct Assigner {
  const Value& value;

  bool operator()(const NumberField& field) const {
    if (value.number) *field.value = *value.number;
    return value.number.has_value();
  }
  bool operator()(const IntegerField& field) const {
    if (value.number) *field.value = std::llround(*value.number);
    return value.number.has_value();
  }
  bool operator()(bool* flag) const {
    if (value.text != "true" && value.text != "false") return false;
    *flag = value.text == "true";
    return true;
  }
  bool operator()(const ChoiceField& choice) const {
    const auto name = std::find(choice.names.begin(), choice.names.end(), value.text);
    if (name == choice.names.end()) return false;
    choice.set(static_cast<std::size_t>(name - choice.names.begin()));
    return true;
  }
  template <class Other>
  bool operator()(const Other&) const {
    return false;
  }
};

void Assign(Scenario& scenario, const std::string& pointer, const Value& value) {
  const std::optional<Field> field = FieldAt(scenario, pointer);
  if (!field || !std::visit(Assigner{value}, field->value)) {
    throw InputError(fmt::format(
        "error: {} cannot be \"{}\" here: only numbers, choices and flags can be varied", pointer,
        value.text));
  }
}

}  // namespace

FieldAssignment::FieldAssignment(std::string_view pointer) : pointer_(pointer) {
  const Field* field = FindField(pointer);
  if (field != nullptr && field->As<SectionField>() != nullptr) {
    throw InputError(fmt::format(
        "error: {0}: a section; `fogline check --explain {0}` lists its fields", pointer));
  }
  if (field == nullptr) {
    const auto suggestion = SuggestPointer(pointer);
    throw InputError(fmt::format("error: {}: no field of a scenario{}", pointer,
                                 suggestion ? fmt::format("; did you mean {}?", *suggestion) : ""));
  }
}

void FieldAssignment::Set(Scenario& scenario, double number) const {
  Assign(scenario, pointer_, {.number = number, .text = ""});
}

void FieldAssignment::Set(Scenario& scenario, std::string_view text) const {
  Assign(scenario, pointer_, {.number = ParseNumber<double>(text), .text = text});
}

}  // namespace fogline
