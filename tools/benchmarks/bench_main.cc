// fogline-bench: measures Fogline and its references in one run on this machine.
// fogline-bench-steps measures the cost of a single Step.
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
#include "tools/benchmarks/present.h"

namespace fogline::benchmarks {
namespace {

struct Arguments {
  bool quick = false;
  bool json = false;
  bool markdown = false;
  int rounds = 0;
  std::vector<std::string> only;
};

std::vector<Comparison> AllComparisons(Effort effort) {
  std::vector<Comparison> all;
  for (const auto& family : {PeerComparisons, LockstepComparisons, DataComparisons}) {
    std::ranges::move(family(effort), std::back_inserter(all));
  }
  return all;
}

/// The error text for a name that no comparison has; "" if a comparison has this name.
std::string WhyNoComparison(const std::string& name) {
  const std::vector<Comparison> all = AllComparisons(Effort::kQuick);
  if (std::ranges::find(all, name, &Comparison::name) != all.end()) return "";
  std::string names;
  for (const Comparison& comparison : all) {
    names += (names.empty() ? "" : ", ") + comparison.name;
  }
  return fmt::format("there is no comparison \"{}\"; the comparisons are {}", name, names);
}

std::vector<Comparison> Wanted(const Arguments& arguments) {
  std::vector<Comparison> wanted = AllComparisons(arguments.quick ? Effort::kQuick : Effort::kFull);
  const auto& only = arguments.only;
  if (only.empty()) return wanted;
  std::erase_if(wanted, [&](const Comparison& comparison) {
    return std::ranges::find(only, comparison.name) == only.end();
  });
  return wanted;
}

int Run(const Arguments& arguments) {
  constexpr int kFullRounds = 7;
  constexpr int kQuickRounds = 3;
  const int rounds = arguments.rounds > 0 ? arguments.rounds
                     : arguments.quick    ? kQuickRounds
                                          : kFullRounds;
  const std::vector<Comparison> wanted = Wanted(arguments);
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
                 "memory (repeatable)")
      ->check(WhyNoComparison)
      ->allow_extra_args(false);
  app.add_flag("--json", arguments.json, "Print as JSON");
  app.add_flag("--markdown", arguments.markdown, "Print a Markdown table");
  app.footer(
      "Run it in the folder of the sources. Exit codes: 0 every goal met, 1 one missed or "
      "not measured,\n2 bad usage, 3 failed.\n\nExamples:\n  fogline-bench --quick\n"
      "  fogline-bench --only udpm --only memq --rounds 11");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kBadInput;
  }
  return Run(arguments);
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
