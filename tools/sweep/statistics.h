// Mean and standard deviation of numbers that come one after another.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

namespace fogline {

/// Mean and standard deviation of what was added; Welford 1962.
class Statistics {
 public:
  void Add(double value) {
    ++count_;
    const double delta = value - mean_;
    mean_ += delta / static_cast<double>(count_);
    squares_ += delta * (value - mean_);
  }
  std::int64_t count() const { return count_; }
  std::optional<double> mean() const { return count_ > 0 ? std::optional(mean_) : std::nullopt; }
  /// Of the sample, n - 1 in the denominator; none with fewer than two values.
  std::optional<double> deviation() const {
    if (count_ < 2) return std::nullopt;
    return std::sqrt(squares_ / static_cast<double>(count_ - 1));
  }

 private:
  std::int64_t count_ = 0;
  double mean_ = 0;
  double squares_ = 0;
};

}  // namespace fogline
