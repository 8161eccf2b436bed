#include "tools/cli/threshold_rows.h"

#include "common/process/interrupt.h"
#include "common/process/progress.h"
#include "tools/sweep/engine.h"

namespace fogline {

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
