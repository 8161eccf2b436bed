// A field of a log over time, with as many points as a screen can show.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace fogline::web {

struct Series {
  bool whole = true;  // whether it has a point for each message of the steps
  std::vector<double> time_s;
  std::vector<double> value;  // NaN: no value
};

/// Simulated time and value of a step. The value is NaN if the step has no value.
struct SeriesPoint {
  double time_s = 0;
  double value = 0;
};

/// All points of the steps from `from` to `to`, if there are at most 2 * `points` steps. Otherwise
/// the steps are divided into `points` buckets of nearly equal length. Each bucket gives its
/// smallest and its largest value, in the order of time, so no peak is lost. A bucket without a
/// value gives one point with NaN.
/// @param at returns the point of a step; nullopt if the step has no message
Series Decimate(std::int64_t from, std::int64_t to, std::int64_t points,
                const std::function<std::optional<SeriesPoint>(std::int64_t step)>& at);

/// The first point of the steps from `from` to `to`, and each point whose value differs from the
/// value of the point before.
/// @param most limit for the number of points
/// @return nullopt if there are more than `most` points
std::optional<Series> Changes(std::int64_t from, std::int64_t to, std::int64_t most,
                              const std::function<std::optional<SeriesPoint>(std::int64_t)>& at);

}  // namespace fogline::web
