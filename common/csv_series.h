// A column of a CSV file as a function of time.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "common/csv.h"

namespace fogline {

/// Linear interpolation between rows, at times that grow from call to call.
/// @pre the times of the rows ascend and span all times of At(); the columns outlive this object
class CsvSeries {
 public:
  /// Times in files are rounded decimals. At a time that differs from a row's time by at most
  /// kSameTime_s, the series has exactly the row's value. The time of a message has the same
  /// resolution, one microsecond.
  static constexpr double kSameTime_s = 1e-6;

  CsvSeries(const std::vector<CsvNumber>& times_s, const std::vector<CsvNumber>& values)
      : times_s_(times_s), values_(values) {}

  double At(double time_s) {
    while (row_ + 1 < times_s_.size() && times_s_[row_ + 1].value <= time_s + kSameTime_s) ++row_;
    const double from_s = times_s_[row_].value;
    const double from = values_[row_].value;
    if (time_s - from_s <= kSameTime_s || row_ + 1 == times_s_.size()) return from;
    const double share = (time_s - from_s) / (times_s_[row_ + 1].value - from_s);
    return std::lerp(from, values_[row_ + 1].value, share);
  }

 private:
  const std::vector<CsvNumber>& times_s_;
  const std::vector<CsvNumber>& values_;
  std::size_t row_ = 0;
};

}  // namespace fogline
