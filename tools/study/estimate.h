// A mean over runs with its interval, and what an interval lets us say.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "services/measures/event_share.h"

namespace fogline {

/// Mean over n runs with its 95 % confidence interval (Student's t). NaN where n is too small: 1
/// for the mean, 2 for the interval.
struct Estimate {
  std::int64_t n = 0;
  double mean;
  double deviation;
  double low;
  double high;
};

/// Of the values that are there (not NaN).
Estimate EstimateOf(std::span<const double> values);

/// Of the differences a[i] - b[i], where both are there: runs of equal seeds have equal noise, and
/// their difference is known better than either. @pre equal sizes
Estimate PairedDifference(std::span<const double> a, std::span<const double> b);

/// What an estimate of a difference lets us say.
enum class Verdict { kLess, kMore, kUndecided };
/// kUndecided where the interval has 0 in it, or is none.
Verdict VerdictOf(const Estimate& difference);

/// "12.3 [12.0, 12.6]"; "–" without a mean.
std::string Text(const Estimate& estimate, int decimals);
/// "2 of 100 runs, 2.0 % [0.2 %, 7.0 %]".
std::string Text(const EventShare& share);
/// "12.3"; "–" for NaN.
std::string Text(double value, int decimals);

}  // namespace fogline
