// The fields of a scenario as values of one type, for code that reads, prints, sets or explains all
// fields in the same way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenario/sections/field.h"
#include "scenario/sections/plans/experiment.h"
#include "scenario/sections/plans/lab.h"
#include "scenario/sections/scenario.h"

namespace fogline {

struct Field;
using FieldList = std::vector<Field>;

struct NumberField {
  double* value;
  NumberSpec spec;
};

struct IntegerField {
  std::int64_t* value;
  IntegerSpec spec;
};

/// A value of an enumeration. `get` and `set` use its index in `names`.
struct ChoiceField {
  std::span<const std::string_view> names;
  std::span<const std::string_view> docs;
  std::function<std::size_t()> get;
  std::function<void(std::size_t)> set;
};

struct NumbersField {
  std::vector<double>* values;
  ListSpec list;
  NumberSpec spec;  // range and unit of each number
};

/// A list of texts.
struct TextsField {
  std::vector<std::string>* values;
  ListSpec list;
};

/// A list of sections.
struct ListField {
  ListSpec list;
  std::function<void(std::size_t)> reset;  // makes a list of this size, with default values
  std::function<FieldList(const std::string& pointer)> items;
};

/// A section, or an item of a list of sections.
struct SectionField {
  NeedSpec need;  // need.choice is "" if no file must have the section
  std::function<FieldList(const std::string& pointer)> fields;
};

/// A field of a section, or an item of a list. A Field refers to the value in the scenario.
struct Field {
  std::string pointer;      // JSON pointer, such as /fog/bias_m
  std::string_view name;    // last segment of the pointer; "" for an item of a list
  std::string_view doc;     // meaning
  std::string_view source;  // source of the default of a number; otherwise ""
  std::variant<NumberField, IntegerField, bool*, std::string*, ChoiceField, NumbersField,
               TextsField, ListField, SectionField>
      value;

  /// The value if it is a T; otherwise null.
  template <class T>
  const T* As() const {
    return std::get_if<T>(&value);
  }
  /// The fields of a section, or the items of a list. The result is empty for other fields.
  FieldList Contents() const;
};

/// The fields at the top level of the scenario, in their order. A field stays valid until the
/// scenario is destroyed or a list of the scenario changes its size.
FieldList FieldsOf(Scenario& scenario);
/// The fields of a published row, with pointers that begin with `pointer`.
FieldList FieldsOf(PublishedRow& row, const std::string& pointer);

/// The fields at the top level of an experiment, or of a laboratory, in the same way as for a
/// scenario.
FieldList FieldsOf(ExperimentPlan& plan);
FieldList FieldsOf(LabPlan& plan);

/// All fields of the scenario and all items of its lists. The contents of a section or list follow
/// the section or list.
FieldList AllFields(Scenario& scenario);
FieldList AllFields(ExperimentPlan& plan);
FieldList AllFields(LabPlan& plan);

/// The index that a segment of a pointer states: digits without a leading zero (RFC 6901, section
/// 4). Nothing if the segment is not an index.
std::optional<std::size_t> ListIndex(std::string_view segment);

/// The field or item with this JSON pointer, if the scenario has it.
std::optional<Field> FieldAt(Scenario& scenario, std::string_view pointer);

}  // namespace fogline
