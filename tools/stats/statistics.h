// Statistics of a measure over the runs of several seeds.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace fogline::stats {

/// Marks a number that does not exist: nothing was measured, or nothing can be computed.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Mean and spread of a sample, in the unit of its values. nullopt means that there are too few
/// values: the mean needs one value, and each other statistic needs two.
struct Summary {
  std::int64_t count = 0;
  std::optional<double> mean;
  /// Standard deviation of the values, with n - 1.
  std::optional<double> deviation;
  /// Half the width of the 95 % confidence interval of the mean: t * deviation / sqrt(n), with
  /// Student's t of n - 1 degrees of freedom. The interval describes the uncertainty of the mean,
  /// and not the spread of the values.
  std::optional<double> ci95;
  /// 5th and 95th percentile of the values, by linear interpolation between the two nearest values
  /// (Hyndman & Fan 1996, definition 7). The values need not be normally distributed.
  std::optional<double> p5;
  std::optional<double> p95;
};

/// Collects values. The object stores all values, 8 bytes each, because percentiles need all of
/// them. A hundred thresholds over 10,000 seeds need 8 MB for each measure.
class Statistics {
 public:
  void Add(double value);
  std::int64_t count() const { return static_cast<std::int64_t>(values_.size()); }
  std::optional<double> mean() const;
  std::optional<double> deviation() const;
  /// Summary of the values so far. The last bits of the mean depend on the order of the values.
  Summary Result() const;

 private:
  std::vector<double> values_;
  double mean_ = 0;
  double squares_ = 0;  // sum of squared distances from the mean
};

}  // namespace fogline::stats
