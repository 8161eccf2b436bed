// fogline-bench: measures Fogline, and the programs that it is compared with, in one run on this
// machine. (Another program, fogline-bench-steps, measures the cost of a single Step.)
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "common/exit_code.h"
#include "common/process/console.h"
#include "tools/benchmarks/comparisons.h"
#include "tools/benchmarks/growth.h"
#include "tools/benchmarks/present.h"

namespace fogline::benchmarks {
namespace {

struct Arguments {
  bool quick = false;
  bool json = false;
  bool markdown = false;
  bool growth = false;
  std::string chart;
  int rounds = 0;
  std::vector<std::string> only;
  std::string against;
};

std::vector<Comparison> AllComparisons(Effort effort, const std::string& against) {
  if (!against.empty()) return AgainstComparisons(effort, against);
  std::vector<Comparison> all;
  for (const auto& family : {PeerComparisons, LockstepComparisons, DataComparisons}) {
    std::ranges::move(family(effort), std::back_inserter(all));
  }
  return all;
}

/// Refuses a name that no comparison has. @throws CLI::ValidationError
void Check(const std::string& name, const std::vector<Comparison>& all) {
  if (std::ranges::find(all, name, &Comparison::name) != all.end()) return;
  std::string names;
  for (const Comparison& comparison : all) {
    names += (names.empty() ? "" : ", ") + comparison.name;
  }
  throw CLI::ValidationError(
      "--only", fmt::format("there is no comparison \"{}\"; the comparisons are {}", name, names));
}

/// @throws CLI::ValidationError for a name in --only that no comparison has
std::vector<Comparison> Wanted(const Arguments& arguments) {
  std::vector<Comparison> wanted =
      AllComparisons(arguments.quick ? Effort::kQuick : Effort::kFull, arguments.against);
  const auto& only = arguments.only;
  if (only.empty()) return wanted;
  for (const std::string& name : only) Check(name, wanted);
  std::erase_if(wanted, [&](const Comparison& comparison) {
    return std::ranges::find(only, comparison.name) == only.end();
  });
  return wanted;
}

int RoundsOf(const Arguments& arguments) {
  constexpr int kFullRounds = 7;
  constexpr int kQuickRounds = 3;
  if (arguments.rounds > 0) return arguments.rounds;
  return arguments.quick ? kQuickRounds : kFullRounds;
}

int RunGrowth(const Arguments& arguments) {
  const int rounds = RoundsOf(arguments);
  const std::vector<Growth> all =
      MeasureGrowth(arguments.quick ? Effort::kQuick : Effort::kFull, rounds);
  if (!arguments.chart.empty()) DrawGrowth(all, arguments.chart);
  const auto present = arguments.json       ? GrowthJson
                       : arguments.markdown ? GrowthMarkdown
                                            : GrowthText;
  fmt::print("{}", present(all, ThisOccasion(rounds)));
  return kDone;
}

int Run(const Arguments& arguments, const std::vector<Comparison>& wanted) {
  const int rounds = RoundsOf(arguments);
  std::vector<Finding> findings;
  for (const Comparison& comparison : wanted) {
    Complain(fmt::format("{} of {}: {}", findings.size() + 1, wanted.size(), comparison.name));
    findings.push_back(Compare(comparison, rounds));
  }
  const Occasion occasion = ThisOccasion(rounds);
  const auto present = arguments.json ? ToJson : arguments.markdown ? ToMarkdown : ToText;
  fmt::print("{}", present(findings, occasion));
  return std::ranges::all_of(findings, &Finding::met) ? kDone : kCheckFailed;
}

int Main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Measures Fogline and the programs that it is compared with, in alternating rounds.",
               "fogline-bench"};
  app.add_flag("--quick", arguments.quick, "Fewer and shorter rounds");
  app.add_option("--rounds", arguments.rounds, "Rounds of each comparison")
      ->check(CLI::Range(1, 1000));
  app.add_option("--only", arguments.only,
                 "octave, sumo, udpm, udpm-messages, udpm-graph, key, python, memq, log, cores, "
                 "thresholds, memory; with --against: against-sweep, against-udpm, against-start "
                 "(repeatable)")
      ->allow_extra_args(false);
  app.add_option("--against", arguments.against,
                 "Compare with the build of another commit: a folder with source and build "
                 "(tools/bench --against COMMIT makes it)")
      ->check(CLI::ExistingDirectory);
  CLI::Option* growth =
      app.add_flag("--growth", arguments.growth,
                   "Measure how the cost grows with followers, steps and runs instead");
  app.add_option("--chart", arguments.chart, "With --growth: draw the chart into this SVG file")
      ->needs(growth);
  app.add_flag("--json", arguments.json, "Print as JSON");
  app.add_flag("--markdown", arguments.markdown, "Print a Markdown table");
  app.footer(
      "Run it in the folder of the sources. Exit codes: 0 every goal met, 1 one missed or "
      "not measured,\n2 bad usage, 3 failed.\n\nExamples:\n  fogline-bench --quick\n"
      "  fogline-bench --only udpm --only memq --rounds 11");
  std::vector<Comparison> wanted;
  try {
    app.parse(argc, argv);
    wanted = Wanted(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  }
  return arguments.growth ? RunGrowth(arguments) : Run(arguments, wanted);
}

}  // namespace
}  // namespace fogline::benchmarks

int main(int argc, char** argv) {
  try {
    return fogline::benchmarks::Main(argc, argv);
  } catch (const std::exception& error) {
    fogline::Complain(fmt::format("fogline-bench: error: {}", error.what()));
    return fogline::kRunFailed;
  }
}
