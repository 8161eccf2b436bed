// A field of a log over time, with as many points as a screen can show.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace fogline::web {

struct Series {
  std::vector<double> time_s;
  std::vector<double> value;  // NaN: no value
};

/// A value of a step: its simulated time and the number. If the number is NaN, the step has none.
struct SeriesPoint {
  double time_s = 0;
  double value = 0;
};

/// All points of the steps from `from` to `to`, if they are at most 2 `points`. Otherwise the steps
/// are put into `points` buckets of nearly equal length, and each bucket gives its smallest and its
/// largest value, in the order of time; so no peak is lost. A bucket without a value gives one
/// point with NaN.
/// @param at gives the point of a step; nullopt if there is no message
Series Decimate(std::int64_t from, std::int64_t to, std::int64_t points,
                const std::function<std::optional<SeriesPoint>(std::int64_t step)>& at);

}  // namespace fogline::web
