// Share of runs that have an event, such as a collision or a detection.
#pragma once

#include <cstdint>

namespace fogline::metrics {

/// A share of runs, with exact bounds of the event's probability.
struct EventShare {
  std::int64_t events = 0;
  std::int64_t runs = 0;
  double share = 0;  // events/runs
  double lower = 0;
  double upper = 1;
};

/// The share of `events` in `runs`, with the bounds of Clopper & Pearson 1934. The bounds contain
/// the event's probability p with at least this confidence, whatever p is. With 0 events in n runs,
/// the upper bound at 95 % is about 3.7/n. (A one-sided bound would be about 3/n.)
/// @param events in [0, runs]  @param runs at least 1  @param confidence in (0, 1)
/// @throws std::invalid_argument
EventShare ClopperPearson(std::int64_t events, std::int64_t runs, double confidence = 0.95);

}  // namespace fogline::metrics
