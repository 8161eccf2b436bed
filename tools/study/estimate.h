// A mean over runs with its interval. The interval gives a verdict on the sign of the mean.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "services/metrics/event_share.h"
#include "tools/stats/statistics.h"

namespace fogline::study {

inline constexpr double kPercent = 100;
/// Probability beyond each end of an interval of 95 %.
inline constexpr double kTail = 0.025;

/// Mean over n runs with its 95 % confidence interval (Student's t). The mean is NaN without a run,
/// and the interval is NaN with fewer than two runs. A time to a collision that never happens is
/// infinite. A mean cannot include infinite values. So runs with an infinite value do not count in
/// n, but in `infinite`.
struct Estimate {
  std::int64_t n = 0;
  double mean = stats::kMissing;
  double deviation = stats::kMissing;
  double low = stats::kMissing;
  double high = stats::kMissing;
  std::int64_t infinite = 0;

  bool has_interval() const { return low <= high; }
};

/// Estimate from the values that are not NaN.
Estimate EstimateOf(std::span<const double> values);

/// Estimate of the differences a[i] - b[i] for which both values exist. Runs of equal seeds have
/// equal noise, so the difference has a smaller error than each of the two values. If both values
/// are infinite, the difference is 0. If only one value is infinite, the difference is infinite.
/// @pre equal sizes
Estimate PairedDifference(std::span<const double> a, std::span<const double> b);

/// PairedDifference() of yes/no values. A value above 0 is a "yes". Of the n pairs, b pairs have a
/// "yes" only in `a`, and c pairs have a "yes" only in `b`. The mean is (b - c)/n. The interval is
/// [low(b) - high(c), high(b) - low(c)]. Here low() and high() are the bounds of Clopper & Pearson
/// of b/n and c/n, each at 97.5 %. The interval contains the true difference with a probability of
/// at least 95 % (Bonferroni). It is within [-1, 1], and its width is above 0 even if no pair
/// differs.
/// @pre equal sizes, and no value is missing
Estimate PairedShareDifference(std::span<const double> a, std::span<const double> b);

/// Verdict from an estimate of a difference.
enum class Verdict {
  kLess,
  kMore,
  kUndecided,  // the interval contains 0, or some differences are infinite
  kTooFew,     // there is no interval
};
Verdict VerdictOf(const Estimate& difference);

/// p-value of the null hypothesis that a mean is 0, by the two-sided t test. The standard error is
/// computed from the interval, which may also come from a bootstrap. The p-value is 1 if there is
/// no interval, or if some values are infinite.
double PValueOfSign(const Estimate& estimate);
/// p-value of the null hypothesis that a mean is farther from 0 than `margin`, by two one-sided t
/// tests (Schuirmann 1987).
double PValueOfEqual(const Estimate& estimate, double margin);

/// Mean and interval as text, such as "12.3 [12.0, 12.6]"; "–" without a mean. If some values are
/// infinite: "12.3 [12.0, 12.6], ∞ in 3 of 100 runs".
std::string Text(const Estimate& estimate, int decimals);
/// Text() with 2 to 6 decimals: as many as give the width of the interval two significant digits.
std::string Text(const Estimate& estimate);
/// The share as text, such as "2 of 100 runs, 2.0 % [0.2 %, 7.0 %]".
std::string Text(const metrics::EventShare& share);
/// The number as text, such as "12.3"; "–" for NaN and infinity.
std::string Text(double value, int decimals);

/// A number in a CSV file; empty for NaN and infinity.
std::string CsvText(double value);
/// Mean and interval as three cells of a CSV file, such as "12.3,12,12.6".
std::string CsvText(const Estimate& estimate);

}  // namespace fogline::study
