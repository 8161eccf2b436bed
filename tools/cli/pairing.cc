#include "tools/cli/pairing.h"

#include <iterator>

#include "scenario/io/loader.h"

namespace fogline::cli {
namespace {

/// The text of a scenario without its section `arbitrator`. Two runs of a pair have the same text.
std::string CommonPart(Scenario scenario) {
  scenario.arbitrator = {};
  return PrintScenario(scenario);
}

/// Whether the log has each step of the run, with the messages that the measures of a pair need.
bool IsWhole(const runner::LoggedRun& run) {
  const std::vector<metrics::Sample>& samples = run.result.samples;
  const auto lacks = run.result.lack.channels | run.result.lack.every;
  const bool has_messages = !lacks[IndexOf<truth_t>()] && !lacks[IndexOf<track_t>()] &&
                            !lacks[IndexOf<follower_command_t>()];
  return has_messages && !run.gaps.Any() && !samples.empty() && samples.back().last &&
         samples.back().step == std::ssize(samples) - 1;
}

}  // namespace

Scenario WithoutTradedControl(Scenario scenario) {
  scenario.arbitrator.policy = Policy::kNone;
  return scenario;
}

std::vector<Pairing> MeasurePairs(std::span<const runner::LoggedRun> runs) {
  std::vector<std::string> common;
  for (const runner::LoggedRun& run : runs) common.push_back(CommonPart(run.scenario));
  std::vector<Pairing> pairs(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].scenario.arbitrator.policy == Policy::kNone) continue;
    for (std::size_t j = 0; j < runs.size(); ++j) {
      if (runs[j].scenario.arbitrator.policy != Policy::kNone || common[i] != common[j]) continue;
      if (!IsWhole(runs[i]) || !IsWhole(runs[j])) {
        pairs[i].unknown = true;
        continue;
      }
      pairs[i] = {
          metrics::MeasurePair(runs[j].result.samples, runs[i].result.samples, runs[i].scenario),
          metrics::FogEffectOf(runs[j].result.measures), false};
      break;
    }
  }
  return pairs;
}

}  // namespace fogline::cli
