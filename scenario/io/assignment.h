// Sets one field of a scenario many times without parsing JSON, for grids and searches.
#pragma once

#include <string>
#include <string_view>

#include "scenario/sections/scenario.h"

namespace fogline {

/// Sets a field that is a number, an integer, a flag or a choice. A JSON pointer names the field.
/// If the field lies in an item of a list, the scenario must have this item.
class FieldAssignment {
 public:
  /// @throws InputError if the pointer names a section, or no field of a scenario
  explicit FieldAssignment(std::string_view pointer);

  /// Sets the field without a check of its range. ParseScenario() with an override checks the
  /// range.
  /// @throws InputError if the field is a text or a list, if the field cannot have this value, or
  ///     if the scenario lacks the item of the list
  void Set(Scenario& scenario, double number) const;
  /// Sets the field to a value that is written as a text, such as 0.5, true or traded.
  void Set(Scenario& scenario, std::string_view text) const;

  const std::string& pointer() const { return pointer_; }

 private:
  std::string pointer_;
};

}  // namespace fogline
