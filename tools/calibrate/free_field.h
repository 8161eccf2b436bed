// A field of a scenario that a calibration may change, and the range in which it looks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenario/assignment.h"
#include "scenario/scenario.h"

namespace fogline {

/// A number or integer outside lists, its bounds and its scale. A search sees a field as its share
/// of the range, in [0, 1]; on a logarithmic scale equal shares are equal factors.
class FreeField {
 public:
  /// "/pointer=lowest:highest", or "/pointer=lowest:highest:log" for a field that spans orders of
  /// magnitude.
  /// @throws InputError if the pointer names no such field, or the bounds are not in order or not
  /// in the field's own range
  explicit FreeField(const std::string& text);

  const std::string& pointer() const { return assignment_.pointer(); }
  std::string_view unit() const { return unit_; }
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }
  bool is_integer() const { return is_integer_; }
  bool is_logarithmic() const { return is_logarithmic_; }

  /// The value at a share of the range, rounded: integers to integers, others to a 10^5th of the
  /// range or finer on a linear scale and to six digits on a logarithmic one, so that a file that
  /// holds the value is fit to be read, and says exactly what was tried.
  double ValueAt(double share) const;
  /// The share at which a value lies; 0 or 1 if it is beyond the bounds.
  double ShareOf(double value) const;

  double Get(const Scenario& scenario) const;
  void Set(Scenario& scenario, double value) const { assignment_.Set(scenario, value); }

 private:
  struct Parts {
    std::string pointer;
    double lowest;
    double highest;
    bool is_logarithmic;
  };
  static Parts Split(const std::string& text);
  FreeField(const std::string& text, const Parts& parts);

  FieldAssignment assignment_;
  double lowest_;
  double highest_;
  bool is_logarithmic_;
  bool is_integer_ = false;
  std::string_view unit_;
};

/// The free fields of a command line. @throws InputError, also if one is given twice
std::vector<FreeField> ParseFreeFields(const std::vector<std::string>& texts);

}  // namespace fogline
