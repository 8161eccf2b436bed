// Sets one field of a scenario repeatedly without reading JSON each time: for grids and searches.
#pragma once

#include <string>
#include <string_view>

#include "scenario/sections/scenario.h"

namespace fogline {

/// Sets the number, integer, flag or choice at a JSON pointer. The field may lie in an item of a
/// list; the scenario must then have this item.
class FieldAssignment {
 public:
  /// @throws InputError if the pointer names no such field
  explicit FieldAssignment(std::string_view pointer);

  /// Sets the field. Does not check the field's range: ParseScenario() with an override does that.
  /// @throws InputError if the field cannot have this value, or its list has no such item
  void Set(Scenario& scenario, double number) const;
  /// The same for a value written as in a file: 0.5, true, traded.
  void Set(Scenario& scenario, std::string_view text) const;

  const std::string& pointer() const { return pointer_; }

 private:
  std::string pointer_;
};

}  // namespace fogline
