// Confidence intervals for statistics other than a plain mean. They come from resamples of the runs
// (bootstrap, Efron 1979).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/random.h"
#include "tools/study/estimate.h"

namespace fogline::study {

/// Number of replicates (resamples of the runs) for an interval. With this number, the error of the
/// interval's ends is at most a tenth of the interval's width.
inline constexpr std::int64_t kReplicates = 1000;

/// Makes replicates of a set of runs. A replicate draws as many runs as the set has, with
/// replacement: it can contain a run several times, or not at all. The draws are the same on every
/// machine. Two statistics that are computed with the same weights are paired, run by run.
class Resampling {
 public:
  Resampling(std::size_t runs, Stream stream) : runs_(runs), stream_(stream) {}

  /// Sets `weights[run]` to the number of times that the replicate contains the run. The sum of the
  /// weights is the number of runs.
  void Draw(std::int64_t replicate, std::vector<double>& weights) const;

 private:
  std::size_t runs_;
  Stream stream_;
};

/// Weighted mean of the values that are not NaN; NaN if the sum of their weights is 0.
double WeightedMean(std::span<const double> values, std::span<const double> weights);

/// An estimate over n runs with the mean `value`. `replicates` has the value of each resample. The
/// interval is from the 2.5th to the 97.5th percentile of the replicates (Efron & Tibshirani 1993,
/// 13.3). There is no interval if there are fewer than two runs or no replicates, or if the value
/// or a replicate is NaN.
Estimate FromReplicates(std::int64_t n, double value, std::vector<double> replicates);

}  // namespace fogline::study
