#include "tools/cli/threshold_rows.h"

#include "common/interrupt.h"
#include "common/process/progress.h"
#include "tools/sweep/engine.h"

namespace fogline::cli {

std::vector<sweep::ThresholdRow> RowsOnAllCores(const Scenario& scenario,
                                                std::span<const double> thresholds,
                                                const sweep::SeedRange& seeds) {
  Progress progress("seed", seeds.count());
  std::vector<sweep::ThresholdRow> rows = sweep::SweepThresholds(
      scenario, thresholds, seeds, sweep::AllCores(), [&](std::int64_t done) {
        progress.Show(done);
        return !WasInterrupted();
      });
  if (WasInterrupted()) throw Interrupted("interrupted");
  return rows;
}

}  // namespace fogline::cli
