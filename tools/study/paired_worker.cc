#include "tools/study/paired_worker.h"

#include <limits>
#include <optional>
#include <type_traits>

#include "services/metrics/run_metrics.h"
#include "services/metrics/safety_improvement.h"
#include "tools/stats/statistics.h"
#include "tools/study/comparison.h"

namespace fogline::study {
namespace {

/// Makes the smallest time to collision infinite instead of missing, if both cars existed but the
/// gap between them never shrank.
void KeepInfinite(metrics::PairMetrics& pair) {
  const bool there = pair.tet_s.has_value();
  if (there && !pair.min_ttc_s) pair.min_ttc_s = std::numeric_limits<double>::infinity();
}

// The values are in the order of ComparedMetrics().
RunValues ValuesOf(metrics::RunMetrics measures, const metrics::PairedMetrics& paired) {
  KeepInfinite(measures.host);
  KeepInfinite(measures.follower);
  RunValues values;
  metrics::VisitPairedMetrics(
      paired, [&](std::string_view, const std::optional<double>& value, std::string_view,
                  std::string_view) { values.push_back(value.value_or(stats::kMissing)); });
  values.push_back(measures.collision == truth_t::COLLISION_NONE ? 0.0 : 1.0);
  metrics::VisitMetrics(measures, [&]<class V>(std::string_view name, const V& value,
                                               std::string_view, std::string_view) {
    if (name == kCollisionCode) return;
    if constexpr (std::is_same_v<V, std::optional<double>>) {
      values.push_back(value.value_or(stats::kMissing));
    } else {
      values.push_back(static_cast<double>(value));
    }
  });
  return values;
}

}  // namespace

std::vector<RunValues> PairedWorker::Compute(std::span<const Scenario> scenarios,
                                             std::int64_t seed) {
  std::vector<Scenario> of_seed(scenarios.begin(), scenarios.end());
  for (Scenario& scenario : of_seed) scenario.seed = seed;
  std::vector<RunValues> runs;
  for (const sweep::PairedRow& row : runs_.Run(of_seed)) {
    runs.push_back(ValuesOf(row.measures, row.paired));
  }
  return runs;
}

RunValues PairedWorker::OfBaseline(const Scenario& scenario) const {
  metrics::MetricsAccumulator measures(scenario);
  metrics::PairedAccumulator pair(scenario);
  for (const metrics::Sample& sample : runs_.baseline()) {
    measures.Add(sample);
    pair.Add(sample, sample);
  }
  return ValuesOf(measures.Result(), pair.Result());
}

}  // namespace fogline::study
