#include "tools/web/log/series.h"

#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace fogline::web {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

void Append(Series& series, const SeriesPoint& point) {
  series.time_s.push_back(point.time_s);
  series.value.push_back(point.value);
}

/// The smallest and the largest value of a bucket.
class Extremes {
 public:
  void Add(const SeriesPoint& point) {
    if (!first_) first_ = point;
    if (std::isnan(point.value)) return;
    if (!least_ || point.value < least_->value) least_ = point;
    if (!most_ || point.value > most_->value) most_ = point;
  }
  void AppendTo(Series& series) const {
    if (!first_) return;
    if (!least_) return Append(series, {.time_s = first_->time_s, .value = kNoValue});
    auto [earlier, later] = std::pair(*least_, *most_);
    if (later.time_s < earlier.time_s) std::swap(earlier, later);
    Append(series, earlier);
    if (later.time_s > earlier.time_s) Append(series, later);
  }

 private:
  std::optional<SeriesPoint> first_;
  std::optional<SeriesPoint> least_;
  std::optional<SeriesPoint> most_;
};

}  // namespace

Series Decimate(std::int64_t from, std::int64_t to, std::int64_t points,
                const std::function<std::optional<SeriesPoint>(std::int64_t)>& at) {
  Series series;
  const std::int64_t steps = to - from + 1;
  if (steps <= 2 * points) {
    for (std::int64_t step = from; step <= to; ++step) {
      if (const auto point = at(step)) Append(series, *point);
    }
    return series;
  }
  series.whole = false;
  for (std::int64_t bucket = 0; bucket < points; ++bucket) {
    const std::int64_t begin = from + bucket * steps / points;
    const std::int64_t end = from + (bucket + 1) * steps / points;
    Extremes extremes;
    for (std::int64_t step = begin; step < end; ++step) {
      if (const auto point = at(step)) extremes.Add(*point);
    }
    extremes.AppendTo(series);
  }
  return series;
}

std::optional<Series> Changes(std::int64_t from, std::int64_t to, std::int64_t most,
                              const std::function<std::optional<SeriesPoint>(std::int64_t)>& at) {
  Series series{.whole = false, .time_s = {}, .value = {}};
  for (std::int64_t step = from; step <= to; ++step) {
    const auto point = at(step);
    if (!point) continue;
    if (!series.value.empty()) {
      const double before = series.value.back();
      if (point->value == before || (std::isnan(point->value) && std::isnan(before))) continue;
    }
    if (std::ssize(series.value) == most) return std::nullopt;
    Append(series, *point);
  }
  return series;
}

}  // namespace fogline::web
