// fogline-bench-steps: measures the cost of each Step function, and of the whole closed loop. The
// inputs come from a recorded run and are repeated in a loop. The algorithms keep their state
// between the calls.
#include <benchmark/benchmark.h>

#include <vector>

#include "scenario/io/loader.h"
#include "services/closed_loop/closed_loop.h"

namespace fogline::benchmarks {
namespace {

/// Copies of the messages of one step.
struct Recorded {
  truth_t truth;
  ego_t ego;
  radar_t radar;
  lidar_t lidar;
  track_t track;
  accel_command_t acc;
  driver_command_t driver;
  arbitration_t host;
  follower_command_t follower;
};

std::vector<Recorded> Record(const Scenario& scenario) {
  std::vector<Recorded> steps;
  closed_loop::ClosedLoop(scenario).Run(0, [&steps](const closed_loop::StepView& step) {
    steps.push_back({step.truth, step.ego, step.radar, step.lidar, step.track, step.acc,
                     step.driver, step.host, step.follower});
  });
  return steps;
}

const Scenario& Paper() {
  static const Scenario scenario = LoadScenario("scenario/paper.json");
  return scenario;
}

/// A scenario with the fog model `beam`, a physical model in which the LiDAR has several beams.
const Scenario& DenseFog() {
  static const Scenario scenario = LoadScenario("scenario/dense_fog.json");
  return scenario;
}

const std::vector<Recorded>& PaperSteps() {
  static const std::vector<Recorded> steps = Record(Paper());
  return steps;
}

/// Steps in which the ACC needed its active-set solver, because the car ahead brakes hard and then
/// stands still.
const std::vector<Recorded>& HardSteps(const Scenario& scenario) {
  static const std::vector<Recorded> steps = [&scenario] {
    std::vector<Recorded> hard = Record(scenario);
    std::erase_if(hard, [](const Recorded& step) {
      return step.acc.solver != static_cast<std::int8_t>(acc::AccController::Solver::kActiveSet);
    });
    return hard;
  }();
  return steps;
}

/// Measures the time of `call` on one recorded step after the other. After the last step it starts
/// again with the first one.
template <class Call>
void Replay(benchmark::State& state, const std::vector<Recorded>& steps, Call&& call) {
  if (steps.empty()) return state.SkipWithError("no such step in the recorded run");
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(call(steps[i]));
    if (++i == steps.size()) i = 0;
  }
}

// Measures a step of the world. All commands are 0, so the cars keep their distances, and the
// number of steps may be arbitrarily large.
void WorldStep(benchmark::State& state) {
  world::World world(Paper());
  world.Start(0);
  arbitration_t host{};
  follower_command_t follower{};
  follower.num_followers = 1;
  follower.acceleration_mps2 = {0};
  follower.safe_distance_m = {0};
  for (auto _ : state) benchmark::DoNotOptimize(world.Step(host, follower));
}
BENCHMARK(WorldStep);

void RadarStep(benchmark::State& state) {
  radar::Radar radar(Paper());
  Replay(state, PaperSteps(), [&](const Recorded& in) { return &radar.Step(in.truth); });
}
BENCHMARK(RadarStep);

void LidarStep(benchmark::State& state) {
  lidar::Lidar lidar(Paper());
  Replay(state, PaperSteps(), [&](const Recorded& in) { return &lidar.Step(in.truth); });
}
BENCHMARK(LidarStep);

void LidarBeamStep(benchmark::State& state) {
  lidar::Lidar lidar(DenseFog());
  static const std::vector<Recorded> steps = Record(DenseFog());
  Replay(state, steps, [&](const Recorded& in) { return &lidar.Step(in.truth); });
}
BENCHMARK(LidarBeamStep);

void FusionStep(benchmark::State& state) {
  fusion::Fusion fusion(Paper());
  Replay(state, PaperSteps(),
         [&](const Recorded& in) { return &fusion.Step(in.ego, in.radar, in.lidar); });
}
BENCHMARK(FusionStep);

void AccUnconstrainedStep(benchmark::State& state) {
  acc::Acc acc(Paper());
  std::vector<Recorded> steps = PaperSteps();
  std::erase_if(steps, [](const Recorded& step) {
    return step.acc.solver != static_cast<std::int8_t>(acc::AccController::Solver::kUnconstrained);
  });
  Replay(state, steps, [&](const Recorded& in) { return &acc.Step(in.ego, in.track); });
}
BENCHMARK(AccUnconstrainedStep);

void AccConstrainedStep(benchmark::State& state) {
  Scenario scenario = Paper();
  scenario.lead.profile = LeadProfile::kEmergencyBrake;
  scenario.arbitrator.policy = Policy::kNone;
  acc::Acc acc(scenario);
  double iterations = 0;
  Replay(state, HardSteps(scenario), [&](const Recorded& in) {
    const accel_command_t& out = acc.Step(in.ego, in.track);
    iterations += out.iterations;
    return &out;
  });
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
}
BENCHMARK(AccConstrainedStep);

void DriverStep(benchmark::State& state) {
  driver::Driver driver(Paper());
  Replay(state, PaperSteps(), [&](const Recorded& in) { return &driver.Step(in.truth); });
}
BENCHMARK(DriverStep);

void ArbitratorStep(benchmark::State& state) {
  arbitrator::Arbitrator arbitrator(Paper());
  Replay(state, PaperSteps(), [&](const Recorded& in) {
    return &arbitrator.Step(in.ego, in.radar, in.lidar, in.track, in.acc, in.driver);
  });
}
BENCHMARK(ArbitratorStep);

void FollowerStep(benchmark::State& state) {
  follower::Follower follower(Paper());
  Replay(state, PaperSteps(), [&](const Recorded& in) { return &follower.Step(in.truth); });
}
BENCHMARK(FollowerStep);

/// A whole run: construction and every step.
void ClosedLoopRun(benchmark::State& state) {
  for (auto _ : state) {
    closed_loop::ClosedLoop(Paper()).Run(
        0, [](const closed_loop::StepView& step) { benchmark::DoNotOptimize(&step); });
  }
  state.counters["per_step"] = benchmark::Counter(
      static_cast<double>(Paper().steps),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(ClosedLoopRun);

void ClosedLoopConstruction(benchmark::State& state) {
  for (auto _ : state) {
    closed_loop::ClosedLoop loop(Paper());
    benchmark::DoNotOptimize(&loop);
  }
}
BENCHMARK(ClosedLoopConstruction);

}  // namespace
}  // namespace fogline::benchmarks

BENCHMARK_MAIN();
