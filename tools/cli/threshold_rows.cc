#include "tools/cli/threshold_rows.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/interrupt.h"
#include "common/process/progress.h"
#include "common/text.h"
#include "services/log/event_log.h"
#include "services/log/log_guard.h"
#include "tools/cli/action.h"
#include "tools/cli/pairing.h"
#include "tools/runner/side_by_side.h"

namespace fogline::cli {
namespace {

/// Adds the runs of a table to its rows, in the order of their seeds. The runs may come in any
/// order.
class TableRows {
 public:
  TableRows(const Scenario& scenario, std::span<const double> thresholds) : scenario_(scenario) {
    for (const double threshold : thresholds) rows_.emplace_back().threshold = threshold;
  }

  /// @param seed index of the seed in the range of seeds
  /// @param row 0 for the run without traded control, 1 for the first threshold, and so on
  void Add(std::int64_t seed, std::size_t row, runner::RunResult result) {
    runs_[seed].emplace(row, std::move(result));
    while (!runs_.empty() && runs_.begin()->first == next_ &&
           runs_.begin()->second.size() == rows_.size() + 1) {
      AddSeed(runs_.begin()->second);
      runs_.erase(runs_.begin());
      ++next_;
    }
  }

  std::vector<sweep::ThresholdRow> Take() { return std::move(rows_); }

 private:
  void AddSeed(const std::map<std::size_t, runner::RunResult>& runs) {
    const runner::RunResult& baseline = runs.at(0);
    const metrics::FogEffect without = metrics::FogEffectOf(baseline.measures);
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      const runner::RunResult& result = runs.at(row + 1);
      rows_[row].Add(result.measures,
                     metrics::MeasurePair(baseline.samples, result.samples, scenario_), without);
    }
  }

  const Scenario& scenario_;
  std::vector<sweep::ThresholdRow> rows_;
  std::map<std::int64_t, std::map<std::size_t, runner::RunResult>> runs_;  // by seed and row
  std::int64_t next_ = 0;
};

// Name of the runs without traded control.
constexpr std::string_view kNone = "none";

/// The log of a run. @param name kNone, or NameOf() the threshold
std::filesystem::path LogOf(const TableRuns& runs, std::int64_t seed, std::string_view name) {
  return runs.logs / fmt::format("{}-seed{}-threshold-{}.lcm", runs.name, seed, name);
}

/// The name of a threshold in the names of logs. Two different thresholds have different names.
std::string NameOf(double threshold) { return fmt::format("{}", threshold); }

/// @throws InputError if a log would replace a file that is no event log
void RefuseForeignFiles(const TableRuns& runs, std::span<const double> thresholds,
                        const sweep::SeedRange& seeds) {
  if (runs.logs.empty()) return;
  for (std::int64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    std::vector<std::filesystem::path> logs{LogOf(runs, seed, kNone)};
    for (const double threshold : thresholds) logs.push_back(LogOf(runs, seed, NameOf(threshold)));
    for (const std::filesystem::path& log : logs) {
      std::error_code ignored;
      if (!std::filesystem::exists(log, ignored) || log::IsEventLogOrEmpty(log)) continue;
      throw InputError(fmt::format(
          "{}: error: --logs: the file is no event log and is not replaced", PathText(log)));
    }
  }
}

/// @param name kNone, or NameOf() the threshold
runner::RunResult RunOne(const TableRuns& runs, const Scenario& scenario, std::string_view name) {
  runner::RunOptions options = runs.options;
  if (!runs.logs.empty()) options.log = LogOf(runs, scenario.seed, name);
  const log::LogGuard log = options.log.empty() ? log::LogGuard() : log::LogGuard(options.log);
  runner::RunResult result = runner::RunScenario(scenario, options);
  if (result.verification && !result.verification->Holds()) {
    throw CheckFailed(
        fmt::format("seed {}, {}: {}", scenario.seed, name, result.verification->Trouble()));
  }
  return result;
}

}  // namespace

std::vector<sweep::ThresholdRow> RowsInMemory(const Scenario& scenario,
                                              std::span<const double> thresholds,
                                              const sweep::SeedRange& seeds, int jobs) {
  Progress progress("seed", seeds.count());
  std::vector<sweep::ThresholdRow> rows =
      sweep::SweepThresholds(scenario, thresholds, seeds, jobs, [&](std::int64_t done) {
        progress.Show(done);
        return !WasInterrupted();
      });
  if (WasInterrupted()) throw Interrupted("interrupted");
  return rows;
}

std::vector<sweep::ThresholdRow> RowsByRuns(const TableRuns& runs, const Scenario& scenario,
                                            std::span<const double> thresholds,
                                            const sweep::SeedRange& seeds) {
  RefuseForeignFiles(runs, thresholds, seeds);
  TableRows rows(scenario, thresholds);
  const auto of_a_seed = static_cast<std::int64_t>(thresholds.size()) + 1;
  Progress progress("run", seeds.count() * of_a_seed);
  std::int64_t done = 0;
  std::mutex mutex;  // protects rows, progress and done
  runner::SideBySide(seeds.count() * of_a_seed, runs.jobs, [&](std::int64_t i) {
    const std::int64_t seed = i / of_a_seed;
    const auto row = static_cast<std::size_t>(i % of_a_seed);
    Scenario its = scenario;
    its.seed = seeds.first + seed;
    if (row > 0) its.arbitrator.threshold = thresholds[row - 1];
    runner::RunResult result = row == 0 ? RunOne(runs, WithoutTradedControl(its), kNone)
                                        : RunOne(runs, its, NameOf(its.arbitrator.threshold));
    const std::lock_guard lock(mutex);
    rows.Add(seed, row, std::move(result));
    progress.Show(++done);
  });
  return rows.Take();
}

}  // namespace fogline::cli
