#include "tools/fogline/threshold_rows.h"

#include <fmt/core.h>

#include "scenario/loader.h"
#include "tools/fogline/interrupt.h"
#include "tools/fogline/progress.h"
#include "tools/sweep/engine.h"

namespace fogline {

void RequireTradedControl(const Scenario& scenario, const std::filesystem::path& file) {
  if (scenario.arbitrator.policy == Policy::kNone) {
    throw InputError(
        fmt::format("{}: error: /arbitrator/policy is none: no threshold matters", file.string()));
  }
}

std::vector<ThresholdRow> RowsOnAllCores(const Scenario& scenario,
                                         std::span<const double> thresholds,
                                         const SeedRange& seeds) {
  Progress progress("seed", seeds.count());
  std::vector<ThresholdRow> rows =
      SweepThresholds(scenario, thresholds, seeds, AllCores(), [&](std::int64_t done) {
        progress.Show(done);
        return !WasInterrupted();
      });
  if (WasInterrupted()) throw Interrupted("interrupted");
  return rows;
}

}  // namespace fogline
