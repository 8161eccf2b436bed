// Compares Fogline's runs in one process with two other programs for the same purpose: a GNU Octave
// script of the paper, and SUMO with three cars. The files of both are in tests/campaign/peers.
#include <cstdint>
#include <fstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "scenario/io/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "services/metrics/run_metrics.h"
#include "tools/benchmarks/comparisons.h"
#include "tools/benchmarks/program.h"

namespace fogline::benchmarks {
namespace {

constexpr double kCars = 3;

/// Runs of the paper's experiment per second, measured in this thread, which uses one core.
double ClosedLoopRunsPerSecond(double duration_s) {
  Scenario scenario = LoadScenario("scenario/paper.json");
  closed_loop::ClosedLoop loop(scenario);
  std::int64_t runs = 0;
  std::int64_t steps = 0;
  double wall_s = 0;
  while (wall_s < duration_s) {
    wall_s += SecondsOf([&] {
      constexpr int kBatch = 100;
      for (int i = 0; i < kBatch; ++i) {
        ++scenario.seed;
        metrics::MetricsAccumulator measures;
        loop.Restart(scenario);
        loop.Run(0, [&](const closed_loop::StepView& step) { measures.Add(step.ToSample()); });
        steps += measures.Result().steps;
      }
      runs += kBatch;
    });
  }
  if (steps != runs * scenario.steps) throw std::runtime_error("a run ended early");
  return static_cast<double>(runs) / wall_s;
}

/// Runs of the same scenario per second by the Octave script, without its start-up time.
double OctaveRunsPerSecond(int runs) {
  const std::filesystem::path scenario = ScratchFolder() / "paper.json";
  std::ofstream(scenario) << PrintScenario(LoadScenario("scenario/paper.json"));
  const ProgramResult result = RunProgram(
      {"octave-cli", "--norc", "tests/campaign/peers/paper.m", scenario, std::to_string(runs)});
  const auto json = nlohmann::json::parse(result.out);
  return json["runs"].get<double>() / json["wall_s"].get<double>();
}

/// Seconds that SUMO takes for `steps` steps of 0.1 s with three cars.
double SumoSeconds(int steps) {
  const std::filesystem::path folder = ScratchFolder() / "sumo";
  if (!std::filesystem::exists(folder)) {
    RunProgram({"tests/campaign/peers/three_cars_in_sumo", folder});
  }
  return RunProgram({"sumo", "--configuration-file", folder / "three_cars.sumocfg", "--end",
                     std::to_string(steps / 10)})
      .wall_s;
}

/// Number of updates of single cars that SUMO makes per second. A short run and a long run need the
/// same time for loading. So the additional updates of the long run are divided by its additional
/// time.
double SumoUpdatesPerSecond(int steps) {
  constexpr int kShort = 1'000;
  return kCars * steps / (SumoSeconds(kShort + steps) - SumoSeconds(kShort));
}

}  // namespace

std::vector<Comparison> PeerComparisons(Effort effort) {
  const bool full = effort == Effort::kFull;
  const double duration_s = full ? 1.0 : 0.3;
  const int sumo_steps = full ? 200'000 : 50'000;
  return {
      {.name = "octave",
       .quantity = "runs per second",
       .unit = "1/s",
       .ours = "closed loop, paper scenario, one core",
       .reference = "GNU Octave script of the paper (EKF, qp, IDM)",
       .bound = Bound::kAtLeast,
       .goal = 3000,
       .measure_ours = [duration_s] { return ClosedLoopRunsPerSecond(duration_s); },
       .measure_reference = [] { return OctaveRunsPerSecond(1); }},
      {.name = "sumo",
       .quantity = "vehicle updates per second",
       .unit = "1/s",
       .ours = "closed loop, sensors and controllers included, one core",
       .reference = "SUMO, 3 cars, IDM and ACC, no sensors",
       .bound = Bound::kAtLeast,
       .goal = 3,
       .measure_ours =
           [duration_s] {
             const auto steps = static_cast<double>(LoadScenario("scenario/paper.json").steps);
             return kCars * steps * ClosedLoopRunsPerSecond(duration_s);
           },
       .measure_reference = [sumo_steps] { return SumoUpdatesPerSecond(sumo_steps); }},
  };
}

}  // namespace fogline::benchmarks
