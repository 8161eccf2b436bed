// How often something happens in runs of which each either has it or not: collisions, detections.
#pragma once

#include <cstdint>

namespace fogline {

/// A share of runs, with exact bounds of the probability behind it.
struct EventShare {
  std::int64_t events = 0;
  std::int64_t runs = 0;
  double share = 0;  // events/runs
  double lower = 0;
  double upper = 1;
};

/// Clopper & Pearson 1934: bounds that hold with at least `confidence`, whatever the probability.
/// With 0 of n events the upper one is about 3/n at 95 % (both tails: 3.7/n).
/// @param events in [0, runs]  @param runs at least 1  @param confidence in (0, 1)
/// @throws std::invalid_argument
EventShare ClopperPearson(std::int64_t events, std::int64_t runs, double confidence = 0.95);

}  // namespace fogline
