#include "tools/cli/pairing.h"

#include "scenario/io/loader.h"

namespace fogline::cli {
namespace {

/// The part of a scenario that two runs of a pair have in common.
std::string CommonPart(Scenario scenario) {
  scenario.arbitrator = {};
  return PrintScenario(scenario);
}

}  // namespace

Scenario WithoutTradedControl(Scenario scenario) {
  scenario.arbitrator.policy = Policy::kNone;
  return scenario;
}

std::vector<std::optional<double>> SafetyImprovements(std::span<const runner::LoggedRun> runs) {
  std::vector<std::string> common;
  for (const runner::LoggedRun& run : runs) common.push_back(CommonPart(run.scenario));
  std::vector<std::optional<double>> improvements(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].scenario.arbitrator.policy == Policy::kNone) continue;
    for (std::size_t j = 0; j < runs.size(); ++j) {
      if (runs[j].scenario.arbitrator.policy != Policy::kNone || common[i] != common[j]) continue;
      improvements[i] = metrics::SafetyImprovementPct(
          runs[j].result.samples, runs[i].result.samples, runs[i].scenario.measures.safety_floor_m);
      break;
    }
  }
  return improvements;
}

}  // namespace fogline::cli
