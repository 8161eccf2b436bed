// Intervals of what is no plain mean, by drawing the runs again (Efron 1979).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/runtime/random.h"
#include "tools/study/estimate.h"

namespace fogline {

/// Replicates of an interval: its ends then are known to a tenth of its width and better.
inline constexpr std::int64_t kReplicates = 1000;

/// Resamples of a number of runs: as many draws from them, with replacement. The same on every
/// machine. What is computed from equal weights is paired, run by run.
class Resampling {
 public:
  Resampling(std::size_t runs, Stream stream) : runs_(runs), stream_(stream) {}

  /// How often each run is in a replicate, `weights[run]`; the sum is the number of runs.
  void Draw(std::int64_t replicate, std::vector<double>& weights) const;

 private:
  std::size_t runs_;
  Stream stream_;
};

/// Mean under weights of the values that are there (not NaN); NaN without one.
double WeightedMean(std::span<const double> values, std::span<const double> weights);

/// A value over n runs with the interval from the 2.5th to the 97.5th percentile of its replicates
/// (Efron & Tibshirani 1993, 13.3). No interval with fewer than two runs, or where a replicate has
/// no value.
Estimate FromReplicates(std::int64_t n, double value, std::vector<double> replicates);

}  // namespace fogline
