#include "tools/study/bootstrap.h"

#include <algorithm>
#include <cmath>

#include "tools/stats/statistics.h"

namespace fogline::study {

void Resampling::Draw(std::int64_t replicate, std::vector<double>& weights) const {
  weights.assign(runs_, 0.0);
  // The draws have a fixed seed, so each call gives the same draws, like a table of random numbers.
  // An interval changes only if the results of the runs change.
  const Random random(0, stream_);
  const auto runs = static_cast<double>(runs_);
  const auto take = [&](double u) {
    weights[std::min(static_cast<std::size_t>(u * runs), runs_ - 1)] += 1;
  };
  for (std::size_t i = 0; i < runs_; i += 2) {
    const auto [u, v] = random.Uniform2(replicate, static_cast<std::uint32_t>(i / 2));
    take(u);
    if (i + 1 < runs_) take(v);
  }
}

double WeightedMean(std::span<const double> values, std::span<const double> weights) {
  double sum = 0;
  double weight = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    sum += weights[i] * values[i];
    weight += weights[i];
  }
  return weight > 0 ? sum / weight : stats::kMissing;
}

Estimate FromReplicates(std::int64_t n, double value, std::vector<double> replicates) {
  Estimate estimate{.n = n,
                    .mean = value,
                    .deviation = stats::kMissing,
                    .low = stats::kMissing,
                    .high = stats::kMissing};
  const bool lacking = std::ranges::any_of(replicates, [](double r) { return std::isnan(r); });
  if (n < 2 || std::isnan(value) || replicates.empty() || lacking) return estimate;
  stats::Statistics statistics;
  for (const double replicate : replicates) statistics.Add(replicate);
  estimate.deviation = statistics.deviation().value_or(stats::kMissing);
  std::ranges::sort(replicates);
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(replicates.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, replicates.size() - 1);
    if (replicates[below] == replicates[above]) return replicates[below];
    return std::lerp(replicates[below], replicates[above], place - static_cast<double>(below));
  };
  estimate.low = at(kTail);
  estimate.high = at(1 - kTail);
  return estimate;
}

}  // namespace fogline::study
