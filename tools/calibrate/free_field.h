// A field of a scenario that a calibration may change, and its range.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenario/io/assignment.h"
#include "scenario/sections/scenario.h"

namespace fogline::calibrate {

/// A number field or integer field of a scenario that is not in a list, with its bounds and its
/// scale. A search gives a value as its share of the range, in [0, 1]. On a logarithmic scale,
/// equal steps of the share multiply the value by equal factors.
class FreeField {
 public:
  /// @param text "/pointer=lowest:highest", or "/pointer=lowest:highest:log" for a field that spans
  /// orders of magnitude
  /// @throws InputError if the text has another form; if the pointer names no number or integer
  /// field, or names the seed or the threshold; if the bounds are not in ascending order, are
  /// outside the field's own range, are not integers although the field is an integer, or are not
  /// above 0 on a logarithmic scale
  explicit FreeField(const std::string& text);

  const std::string& pointer() const { return assignment_.pointer(); }
  std::string_view unit() const { return unit_; }
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }
  bool is_integer() const { return is_integer_; }
  bool is_logarithmic() const { return is_logarithmic_; }

  /// The rounded value at a share of the range. An integer is rounded to an integer. A number on a
  /// linear scale is rounded to 1e-5 of the range or finer. A number on a logarithmic scale is
  /// rounded to six digits. So the text of the value in a file is short, and is exactly the value
  /// that was evaluated.
  double ValueAt(double share) const;
  /// The share of the range that belongs to a value; 0 or 1 if the value is outside the bounds.
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

/// The free fields of a command line. @throws InputError, also if a field is given twice
std::vector<FreeField> ParseFreeFields(const std::vector<std::string>& texts);

}  // namespace fogline::calibrate
