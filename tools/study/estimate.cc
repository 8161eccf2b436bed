#include "tools/study/estimate.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <boost/math/distributions/students_t.hpp>

#include "tools/report/html.h"
#include "tools/stats/statistics.h"

namespace fogline::study {
namespace {

/// Collects the values of an estimate.
class Collection {
 public:
  void Add(double value) {
    if (std::isfinite(value)) {
      statistics_.Add(value);
    } else if (std::isinf(value)) {
      ++infinite_;
    }
  }

  Estimate Result() const {
    const stats::Summary summary = statistics_.Result();
    const double mean = summary.mean.value_or(stats::kMissing);
    const double half = summary.ci95.value_or(stats::kMissing);
    return {.n = summary.count,
            .mean = mean,
            .deviation = summary.deviation.value_or(stats::kMissing),
            .low = mean - half,
            .high = mean + half,
            .infinite = infinite_};
  }

 private:
  stats::Statistics statistics_;
  std::int64_t infinite_ = 0;
};

/// P(T > distance / standard error), where T has Student's t distribution with n - 1 degrees of
/// freedom.
double ProbabilityAbove(const Estimate& estimate, double distance) {
  constexpr double kHalfLevel = 0.025;  // probability beyond each end of the interval
  if (!estimate.has_interval() || estimate.infinite > 0 || estimate.n < 2) return 1;
  const boost::math::students_t t(static_cast<double>(estimate.n - 1));
  const double error = (estimate.high - estimate.low) / 2 /
                       boost::math::quantile(boost::math::complement(t, kHalfLevel));
  if (error > 0) return boost::math::cdf(boost::math::complement(t, distance / error));
  return distance > 0 ? 0.0 : 1.0;
}

}  // namespace

Estimate EstimateOf(std::span<const double> values) {
  Collection collection;
  for (const double value : values) collection.Add(value);
  return collection.Result();
}

Estimate PairedDifference(std::span<const double> a, std::span<const double> b) {
  Collection collection;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool equal = std::isinf(a[i]) && a[i] == b[i];
    collection.Add(equal ? 0 : a[i] - b[i]);
  }
  return collection.Result();
}

Estimate PairedShareDifference(std::span<const double> a, std::span<const double> b) {
  Collection collection;
  std::int64_t only_a = 0;
  std::int64_t only_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool in_a = a[i] > 0;
    const bool in_b = b[i] > 0;
    collection.Add((in_a ? 1.0 : 0.0) - (in_b ? 1.0 : 0.0));
    only_a += in_a && !in_b ? 1 : 0;
    only_b += in_b && !in_a ? 1 : 0;
  }
  Estimate estimate = collection.Result();
  if (!estimate.has_interval()) return estimate;
  constexpr double kEach = 1 - kTail;  // the two errors of 2.5 % add up to at most 5 %
  const metrics::EventShare of_a = metrics::ClopperPearson(only_a, estimate.n, kEach);
  const metrics::EventShare of_b = metrics::ClopperPearson(only_b, estimate.n, kEach);
  estimate.low = of_a.lower - of_b.upper;
  estimate.high = of_a.upper - of_b.lower;
  return estimate;
}

Verdict VerdictOf(const Estimate& difference) {
  if (!difference.has_interval()) return Verdict::kTooFew;
  if (difference.infinite > 0) return Verdict::kUndecided;
  if (difference.low > 0) return Verdict::kMore;
  if (difference.high < 0) return Verdict::kLess;
  return Verdict::kUndecided;
}

double PValueOfSign(const Estimate& estimate) {
  return std::min(1.0, 2 * ProbabilityAbove(estimate, std::abs(estimate.mean)));
}

double PValueOfEqual(const Estimate& estimate, double margin) {
  return ProbabilityAbove(estimate, margin - std::abs(estimate.mean));
}

std::string Text(double value, int decimals) { return report::Decimal(value, decimals); }

std::string Text(const Estimate& estimate, int decimals) {
  std::string text = Text(estimate.mean, decimals);
  if (estimate.has_interval()) {
    text += fmt::format(" [{}, {}]", Text(estimate.low, decimals), Text(estimate.high, decimals));
  }
  if (estimate.infinite == 0) return text;
  const std::int64_t runs = estimate.n + estimate.infinite;
  return fmt::format("{}∞ in {} of {} runs", estimate.n == 0 ? "" : text + ", ", estimate.infinite,
                     runs);
}

std::string Text(const Estimate& estimate) {
  constexpr double kFewest = 2;
  constexpr double kMost = 6;
  const double width = estimate.high - estimate.low;
  const bool wide = !estimate.has_interval() || !(width > 0);
  const double decimals =
      wide ? kFewest : std::clamp(std::ceil(1 - std::log10(width)), kFewest, kMost);
  return Text(estimate, static_cast<int>(decimals));
}

std::string Text(const metrics::EventShare& share) {
  return fmt::format("{} of {} runs, {:.1f} % [{:.1f} %, {:.1f} %]", share.events, share.runs,
                     kPercent * share.share, kPercent * share.lower, kPercent * share.upper);
}

std::string CsvText(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

std::string CsvText(const Estimate& estimate) {
  return fmt::format("{},{},{}", CsvText(estimate.mean), CsvText(estimate.low),
                     CsvText(estimate.high));
}

}  // namespace fogline::study
