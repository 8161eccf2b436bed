#include "tools/stats/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <boost/math/distributions/students_t.hpp>

namespace fogline::stats {
namespace {

/// Half of the probability outside a confidence interval of 95 %.
constexpr double kTail = 0.025;

/// The value of `sorted` at the position `share`, from 0 (first value) to 1 (last value). The
/// result is interpolated linearly between the two nearest values.
double At(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

}  // namespace

void Statistics::Add(double value) {
  values_.push_back(value);
  const double delta = value - mean_;
  mean_ += delta / static_cast<double>(values_.size());  // Welford 1962
  squares_ += delta * (value - mean_);
}

std::optional<double> Statistics::mean() const {
  return values_.empty() ? std::nullopt : std::optional(mean_);
}

std::optional<double> Statistics::deviation() const {
  if (values_.size() < 2) return std::nullopt;
  return std::sqrt(squares_ / static_cast<double>(values_.size() - 1));
}

Summary Statistics::Result() const {
  Summary summary{.count = count(), .mean = mean(), .deviation = deviation()};
  if (values_.size() < 2) return summary;
  const auto size = static_cast<double>(values_.size());
  const boost::math::students_t distribution(size - 1);
  summary.ci95 = quantile(complement(distribution, kTail)) * *summary.deviation / std::sqrt(size);
  std::vector<double> sorted = values_;
  std::sort(sorted.begin(), sorted.end());
  summary.p5 = At(sorted, 0.05);
  summary.p95 = At(sorted, 0.95);
  return summary;
}

}  // namespace fogline::stats
