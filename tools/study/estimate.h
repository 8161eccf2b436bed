// A mean over runs with its interval, and what an interval lets us say.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "services/measures/event_share.h"

namespace fogline {

/// Mean over n runs with its 95 % confidence interval (Student's t). NaN where n is too small: 1
/// for the mean, 2 for the interval. A time to a collision that never comes is infinite, and no
/// mean of others tells of it: such runs are not among the n, but counted beside them.
struct Estimate {
  std::int64_t n = 0;
  double mean = std::numeric_limits<double>::quiet_NaN();
  double deviation = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  std::int64_t infinite = 0;

  bool has_interval() const { return low <= high; }
};

/// Of the values that are there (not NaN).
Estimate EstimateOf(std::span<const double> values);

/// Of the differences a[i] - b[i], where both are there: runs of equal seeds have equal noise, and
/// their difference is known better than either. Where both are infinite it is 0; where one is, it
/// is infinite. @pre equal sizes
Estimate PairedDifference(std::span<const double> a, std::span<const double> b);

/// What an estimate of a difference lets us say.
enum class Verdict {
  kLess,
  kMore,
  kUndecided,  // the interval has 0 in it, or some differences are infinite
  kTooFew,     // there is no interval
};
Verdict VerdictOf(const Estimate& difference);

/// "12.3 [12.0, 12.6]"; "–" without a mean; "12.3 [12.0, 12.6], ∞ in 3 of 100 runs".
std::string Text(const Estimate& estimate, int decimals);
/// The same with as many decimals as give the interval two digits: 2 to 6.
std::string Text(const Estimate& estimate);
/// "2 of 100 runs, 2.0 % [0.2 %, 7.0 %]".
std::string Text(const EventShare& share);
/// "12.3"; "–" for what is not finite.
std::string Text(double value, int decimals);

/// A number in a CSV file; empty for what is not finite.
std::string CsvText(double value);

}  // namespace fogline
