// Extremes and means of values that are added one after another, and the tolerance for equal times.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

namespace fogline::metrics {

/// The times of steps are whole microseconds. So two times in seconds count as equal if they differ
/// by less than kSameTime_s, half a microsecond.
inline constexpr double kSameTime_s = 0.5e-6;

/// Sets `least` to `value` if `value` is smaller or is the first value. A missing value (NaN) has
/// no effect.
inline void Lower(std::optional<double>& least, double value) {
  if (!std::isnan(value) && (!least || value < *least)) least = value;
}

/// Sets `most` to `value` if `value` is larger or is the first value. A missing value (NaN) has no
/// effect.
inline void Raise(std::optional<double>& most, double value) {
  if (!std::isnan(value) && (!most || value > *most)) most = value;
}

/// Mean of the added values; missing values (NaN) do not count.
class Mean {
 public:
  void Add(double value) {
    if (std::isnan(value)) return;
    sum_ += value;
    ++count_;
  }
  /// The mean; nullopt without a value.
  std::optional<double> Value() const {
    if (count_ == 0) return std::nullopt;
    return sum_ / static_cast<double>(count_);
  }

 private:
  double sum_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace fogline::metrics
