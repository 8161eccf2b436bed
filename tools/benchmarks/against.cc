// Compares this build with the build of another commit. The comparison uses only the command line
// of `fogline`, because both builds have the same command line.
#include <nlohmann/json.hpp>

#include "tools/benchmarks/comparisons.h"
#include "tools/benchmarks/program.h"

namespace fogline::benchmarks {
namespace {

/// A folder of sources and the folder of its build.
struct Tree {
  std::filesystem::path source;
  std::filesystem::path build;

  std::filesystem::path Program() const { return build / "bin/fogline"; }
  std::filesystem::path Scenario() const { return source / "scenario/paper.json"; }
};

/// Rows per second on one core. A row is a run and its paired run without traded control.
double RowsPerSecond(const Tree& tree, int rows) {
  const ProgramResult result =
      RunProgram({tree.Program(), "sweep", tree.Scenario(), "--seeds", "1:" + std::to_string(rows),
                  "--jobs", "1", "--force", "--json", "--out", ScratchFolder() / "against.csv"});
  std::filesystem::remove(ScratchFolder() / "against.csv");
  return rows / nlohmann::json::parse(result.out)["wall_s"].get<double>();
}

/// Microseconds per step of a run with nine processes. The times of a long and of a short run
/// include the same cost of starting processes. So the difference of these times is the time for
/// `steps` steps without this cost.
double MicrosecondsPerStep(const Tree& tree, int steps) {
  constexpr int kShort = 100;
  const std::filesystem::path log = ScratchFolder() / "against.lcm";
  const auto seconds = [&](int count) {
    std::filesystem::remove(log);
    return RunProgram({tree.Program(), "run", tree.Scenario(), "--transport", "udpm", "--quiet",
                       "--set", "/steps=" + std::to_string(count), "--log", log})
        .wall_s;
  };
  return 1e6 * (seconds(kShort + steps) - seconds(kShort)) / steps;
}

/// Milliseconds of `fogline --version`, from the start of the program to its end.
double StartMilliseconds(const Tree& tree) {
  constexpr int kStarts = 20;
  double wall_s = 0;
  for (int i = 0; i < kStarts; ++i) wall_s += RunProgram({tree.Program(), "--version"}).wall_s;
  return 1000 * wall_s / kStarts;
}

}  // namespace

std::vector<Comparison> AgainstComparisons(Effort effort, const std::filesystem::path& folder) {
  const bool full = effort == Effort::kFull;
  const int rows = full ? 4'000 : 1'000;
  const int steps = full ? 5'000 : 1'000;
  const Tree here{".", std::filesystem::path(ProgramPath("fogline")).parent_path().parent_path()};
  const Tree there{folder / "source", folder / "build"};
  return {
      {.name = "against-sweep",
       .quantity = "rows per second",
       .unit = "1/s",
       .ours = "`fogline sweep` on one core",
       .reference = "the other commit",
       .bound = Bound::kAtLeast,
       .goal = 1,
       .measure_ours = [here, rows] { return RowsPerSecond(here, rows); },
       .measure_reference = [there, rows] { return RowsPerSecond(there, rows); }},
      {.name = "against-udpm",
       .quantity = "time per step",
       .unit = "us",
       .ours = "lockstep over udpm, nine processes",
       .reference = "the other commit",
       .goal = 1,
       .measure_ours = [here, steps] { return MicrosecondsPerStep(here, steps); },
       .measure_reference = [there, steps] { return MicrosecondsPerStep(there, steps); }},
      {.name = "against-start",
       .quantity = "time of `fogline --version`",
       .unit = "ms",
       .ours = "start of the program",
       .reference = "the other commit",
       .goal = 1,
       .measure_ours = [here] { return StartMilliseconds(here); },
       .measure_reference = [there] { return StartMilliseconds(there); }},
  };
}

}  // namespace fogline::benchmarks
