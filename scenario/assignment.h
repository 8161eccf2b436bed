// One field of a scenario set again and again, without reading JSON each time: for grids and
// searches.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.h"

namespace fogline {

/// A number, integer, flag or choice, by its JSON pointer; in a list too, which then has the item.
class FieldAssignment {
 public:
  /// @throws InputError if the pointer names no such field
  explicit FieldAssignment(std::string_view pointer);

  /// Sets the field. @throws InputError if that is none of its values, or its list has no such
  /// item. The value is not checked against the field's range: ParseScenario() with an override
  /// does that, once.
  void Set(Scenario& scenario, double number) const;
  /// The same for a value as it stands in a file: 0.5, true, traded.
  void Set(Scenario& scenario, std::string_view text) const;

  const std::string& pointer() const { return pointer_; }

 private:
  std::string pointer_;
  std::vector<std::string> path_;
};

}  // namespace fogline
