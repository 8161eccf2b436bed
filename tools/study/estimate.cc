#include "tools/study/estimate.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tools/report/html.h"
#include "tools/sweep/statistics.h"

namespace fogline {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kPercent = 100;

Estimate EstimateOf(const Statistics& statistics) {
  const Summary summary = statistics.Result();
  const double mean = summary.mean.value_or(kNone);
  const double half = summary.ci95.value_or(kNone);
  return {.n = summary.count,
          .mean = mean,
          .deviation = summary.deviation.value_or(kNone),
          .low = mean - half,
          .high = mean + half};
}

}  // namespace

Estimate EstimateOf(std::span<const double> values) {
  Statistics statistics;
  for (const double value : values) {
    if (std::isfinite(value)) statistics.Add(value);
  }
  return EstimateOf(statistics);
}

Estimate PairedDifference(std::span<const double> a, std::span<const double> b) {
  Statistics statistics;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = a[i] - b[i];
    if (std::isfinite(difference)) statistics.Add(difference);
  }
  return EstimateOf(statistics);
}

Verdict VerdictOf(const Estimate& difference) {
  if (difference.low > 0) return Verdict::kMore;
  if (difference.high < 0) return Verdict::kLess;
  return Verdict::kUndecided;
}

std::string Text(double value, int decimals) { return Decimal(value, decimals); }

std::string Text(const Estimate& estimate, int decimals) {
  if (std::isnan(estimate.low)) return Text(estimate.mean, decimals);
  return fmt::format("{} [{}, {}]", Text(estimate.mean, decimals), Text(estimate.low, decimals),
                     Text(estimate.high, decimals));
}

std::string Text(const EventShare& share) {
  return fmt::format("{} of {} runs, {:.1f} % [{:.1f} %, {:.1f} %]", share.events, share.runs,
                     kPercent * share.share, kPercent * share.lower, kPercent * share.upper);
}

}  // namespace fogline
