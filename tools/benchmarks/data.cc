// Sweeps and logs: the effect of a second core, the memory of a sweep, the time to read a log.
#include <nlohmann/json.hpp>

#include "tools/benchmarks/bare_lcm.h"
#include "tools/benchmarks/comparisons.h"
#include "tools/benchmarks/program.h"

namespace fogline::benchmarks {
namespace {

// A step has nine messages, so these steps have 1,000,008 messages.
constexpr int kLogSteps = 111'112;

ProgramResult Sweep(int rows, int jobs) {
  return RunProgram({ProgramPath("fogline"), "sweep", "scenario/paper.json", "--seeds",
                     "1:" + std::to_string(rows), "--jobs", std::to_string(jobs), "--force",
                     "--json", "--out",
                     ScratchFolder() / ("sweep-" + std::to_string(rows) + ".csv")});
}

/// Rows of a sweep per second. A row is a run and its paired run without traded control. This
/// function removes the files of earlier sweeps first.
double SweepRowsPerSecond(int rows, int jobs) {
  for (const auto& entry : std::filesystem::directory_iterator(ScratchFolder())) {
    if (entry.path().filename().string().starts_with("sweep-")) {
      std::filesystem::remove(entry.path());
    }
  }
  return rows / nlohmann::json::parse(Sweep(rows, jobs).out)["wall_s"].get<double>();
}

/// Rows per second, on one core, of a sweep with this number of thresholds of the arbitrator.
double ThresholdRowsPerSecond(int thresholds, int seeds) {
  const std::string grid = thresholds == 1 ? "0.5" : "0.1:0.9:" + std::to_string(thresholds);
  const ProgramResult result =
      RunProgram({ProgramPath("fogline"), "sweep", "scenario/dense_fog.json", "--grid",
                  "/arbitrator/threshold=" + grid, "--seeds", "1:" + std::to_string(seeds),
                  "--jobs", "1", "--force", "--json", "--out", ScratchFolder() / "thresholds.csv"});
  return thresholds * seeds / nlohmann::json::parse(result.out)["wall_s"].get<double>();
}

double SweepPeakMemory_mb(int rows) {
  SweepRowsPerSecond(1, 1);  // removes the files of earlier sweeps
  return Sweep(rows, 2).peak_memory_mb;
}

/// The log of a run with a million messages. The first call makes the log. It also reads the log
/// once. So the log is in the page cache for both programs that are compared.
const std::filesystem::path& LargeLog() {
  static const std::filesystem::path file = [] {
    const std::filesystem::path log = ScratchFolder() / "large.lcm";
    RunProgram({ProgramPath("fogline"), "run", "scenario/paper.json", "--quiet", "--transport",
                "direct", "--log", log, "--set", "/steps=" + std::to_string(kLogSteps)});
    BareLogReadSeconds(log);
    return log;
  }();
  return file;
}

double MetricsSeconds() {
  return RunProgram({ProgramPath("fogline"), "metrics", LargeLog(), "--json"}).wall_s;
}

}  // namespace

std::vector<Comparison> DataComparisons(Effort effort) {
  const bool full = effort == Effort::kFull;
  const int rows = full ? 4'000 : 1'000;
  return {
      {.name = "log",
       .quantity = "time for a log of a million messages",
       .unit = "s",
       .ours = "`fogline metrics`, digest included",
       .reference = "LCM's event log reader, doing nothing with them",
       .goal = 1.5,
       .measure_ours = [] { return MetricsSeconds(); },
       .measure_reference = [] { return BareLogReadSeconds(LargeLog()); }},
      {.name = "cores",
       .quantity = "rows per second",
       .unit = "1/s",
       .ours = "`fogline sweep` on two cores",
       .reference = "on one",
       .bound = Bound::kAtLeast,
       .goal = 1.9,
       .measure_ours = [rows] { return SweepRowsPerSecond(rows, 2); },
       .measure_reference = [rows] { return SweepRowsPerSecond(rows, 1); }},
      {.name = "thresholds",
       .quantity = "rows per second",
       .unit = "1/s",
       .ours = "`fogline sweep` of nine thresholds in dense fog",
       .reference = "of one threshold",
       .bound = Bound::kAtLeast,
       .goal = 3,
       .measure_ours = [full] { return ThresholdRowsPerSecond(9, full ? 200 : 50); },
       .measure_reference = [full] { return ThresholdRowsPerSecond(1, full ? 200 : 50); }},
      {.name = "memory",
       .quantity = "peak memory",
       .unit = "MB",
       .ours = "`fogline sweep` of 10,000 rows",
       .reference = "of 1,000 rows",
       .goal = 1.2,
       .measure_ours = [] { return SweepPeakMemory_mb(10'000); },
       .measure_reference = [] { return SweepPeakMemory_mb(1'000); }},
  };
}

}  // namespace fogline::benchmarks
