// Checks that runs in the closed loop and their measures allocate no memory after the first step.
// The runs cover every shipped scenario with every fog model and policy, columns of mixed vehicles,
// requests to take over, and a human driver with all weaknesses. The program also checks that no
// step of the ACC allocates memory, on any path of its solver, and no step of the models of
// vehicle, driver and follower. The program replaces malloc, so it is separate from other tests. It
// prints the numbers of allocations, and exits with 1 if a check fails.
#include <cstddef>
#include <cstdio>

#include "scenario/sections/decision.h"
#include "services/acc/acc_controller.h"
#include "services/decision/policies/policies.h"
#include "services/metrics/follower_metrics.h"
#include "services/metrics/run_metrics.h"
#include "services/metrics/safety_improvement.h"
#include "services/models/driver/fog_sight.h"
#include "services/models/driver/human_driver.h"
#include "services/models/follower/safety_response.h"
#include "services/models/vehicle/longitudinal_vehicle.h"
#include "tests/property/services/acc/draw.h"
#include "tests/property/services/closed_loop/shipped.h"
#include "tests/support/find_row.h"

// Functions of the C library, which the replacements below call.
extern "C" void* __libc_malloc(std::size_t size);                       // NOLINT
extern "C" void* __libc_calloc(std::size_t count, std::size_t size);    // NOLINT
extern "C" void* __libc_realloc(void* block, std::size_t size);         // NOLINT
extern "C" void* __libc_memalign(std::size_t align, std::size_t size);  // NOLINT

namespace {
long allocations = 0;
}  // namespace

extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
extern "C" void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
extern "C" void* realloc(void* block, std::size_t size) {
  ++allocations;
  return __libc_realloc(block, size);
}
extern "C" void* aligned_alloc(std::size_t align, std::size_t size) {
  ++allocations;
  return __libc_memalign(align, size);
}

namespace fogline::test {
namespace {

// The number of allocations in random steps of the ACC, with and without a target, in situations
// from steady following to an unavoidable collision. Also counts the steps in which the solver ran.
long ControllerAllocations(int& solver_steps) {
  Draw draw(1);
  acc::AccController acc(AccSection{}, 0.1);
  const long before = allocations;
  for (int k = 0; k < 5000; ++k) {
    const double scale = draw.LogUniform(0.01, 1);
    const acc::AccController::Output output =
        acc.Step({.distance_m = 33 + scale * draw.Uniform(-33, 60),
                  .relative_speed_mps = scale * draw.Uniform(-15, 15),
                  .speed_mps = 20 + scale * draw.Uniform(-20, 30),
                  .acceleration_mps2 = scale * draw.Uniform(-8, 5),
                  .has_target = draw.Chance(0.9)});
    if (output.solver == acc::AccController::Solver::kActiveSet) ++solver_steps;
  }
  return allocations - before;
}

bool CheckController() {
  int solver_steps = 0;
  const long made = ControllerAllocations(solver_steps);
  std::printf("controller: %ld allocations in 5000 steps, %d of them with solver\n", made,
              solver_steps);
  return made == 0 && solver_steps > 1000;
}

// Whether the models allocate no memory while a human drives a car uphill and through fog. The
// first step counts, too.
bool CheckModels() {
  models::LongitudinalVehicle car(models::kSedan, models::FrictionOf(Surface::kWet),
                                  models::GradeProfile({{0, 0}, {500, 0.05}}), 0.1);
  const models::FogSight sight{FogSightParameters{}};
  models::HumanDriver driver(HumanParameters{},
                             models::Following(FollowingModel::kAccIdm, DriverSection{}),
                             Random(1, Stream::kHumanErrors), 0.1);
  models::SafetyResponse fuzzy(models::SafetyModel::kFuzzy, 0.1);
  models::Motion motion{0, 20};
  const long before = allocations;
  car.Begin(motion, 0);
  for (std::int64_t k = 0; k < 1000; ++k) {
    const double lead_mps = k / 100 % 2 == 0 ? 10 : 25;
    const models::Situation truth{
        .speed_mps = motion.speed_mps,
        .ahead = models::CarAhead{.gap_m = static_cast<double>(k % 70), .speed_mps = lead_mps}};
    const double command = driver.Step(k, sight.Perceive(truth, 60)) - fuzzy.Step(truth);
    motion = models::Advance(motion, car.Step(command, motion), 0.1);
  }
  const long made = allocations - before;
  std::printf("models: %ld allocations in 1000 steps\n", made);
  return made == 0;
}

// The number of allocations from the end of step 0 to the end of the last step.
long LoopAllocations(const Scenario& scenario, std::int64_t& steps) {
  closed_loop::ClosedLoop loop(scenario);
  metrics::MetricsAccumulator measures;
  metrics::FollowerAccumulator followers;
  metrics::PairedAccumulator pair(scenario);
  long after_first = 0;
  long after_last = 0;
  steps = 0;
  loop.Run(1, [&](const closed_loop::StepView& step) {
    const metrics::Sample sample = step.ToSample();
    measures.Add(sample);
    followers.Add(step.truth, step.follower);
    pair.Add(sample, sample);
    after_last = allocations;
    if (steps++ == 0) after_first = allocations;
  });
  return after_last - after_first;
}

// Whether a run allocates no memory after step 0 if the driver has all weaknesses together, and
// also reads HOST_COMMAND.
bool CheckHuman(Scenario scenario) {
  scenario.human.following = FollowingModel::kAccIdm;
  scenario.human.sight = Sight::kFog;
  scenario.human.misjudges = true;
  scenario.human.loses_awareness = true;
  std::int64_t steps = 0;
  const long made = LoopAllocations(scenario, steps);
  std::printf("human driver: %ld allocations in %ld steps\n", made, static_cast<long>(steps));
  return made == 0 && steps > 100;
}

bool CheckLoop(const Shipped& shipped) {
  bool clean = true;
  Scenario scenario = shipped.scenario;
  scenario.arbitrator.transfer = {
      .profile = TransferProfile::kSigmoid, .hysteresis = Hysteresis::kSprt, .gate = true};
  for (std::size_t fog = 0; fog < ChoiceNames<FogModel>::kNames.size(); ++fog) {
    scenario.fog.model = static_cast<FogModel>(fog);
    for (std::size_t policy = 0; policy < ChoiceNames<Policy>::kNames.size(); ++policy) {
      scenario.arbitrator.policy = static_cast<Policy>(policy);
      std::int64_t steps = 0;
      const long made = LoopAllocations(scenario, steps);
      std::printf("%s, fog %s, %s: %ld allocations in %ld steps\n", shipped.name.c_str(),
                  ChoiceNames<FogModel>::kNames[fog].data(),
                  ChoiceNames<Policy>::kNames[policy].data(), made, static_cast<long>(steps));
      clean = clean && made == 0 && steps > 100;
    }
  }
  return clean;
}

/// Whether a run with a column of vehicles behind the host, on a hill, allocates no memory after
/// step 0.
bool CheckTraffic(const Shipped& shipped) {
  Scenario scenario = shipped.scenario;
  scenario.world.end_on_collision = false;
  scenario.followers.count = 7;
  scenario.followers.driver = FollowerDriver::kDrawn;
  scenario.followers.style = FollowerStyle::kDrawn;
  scenario.followers.sight = Sight::kFog;
  scenario.followers.safety_model = SafetyModelChoice::kReferenceHuman;
  scenario.host_vehicle.model = VehicleModel::kLongitudinal;
  scenario.follower_vehicle = {.model = VehicleModel::kLongitudinal, .car = CarKind::kCompact};
  scenario.road.grade = {{0, 0}, {300, 0.05}};
  std::int64_t steps = 0;
  const long made = LoopAllocations(scenario, steps);
  std::printf("%s, vehicles and people: %ld allocations in %ld steps\n", shipped.name.c_str(), made,
              static_cast<long>(steps));
  return made == 0 && steps > 100;
}

// Whether runs with requests to take over allocate no memory after step 0. Some drivers take over
// in time, some late, some never.
bool CheckTakeOver(Scenario scenario) {
  scenario.arbitrator.take_over.mode = TakeOverMode::kRequested;
  scenario.arbitrator.take_over.time.mean_s = scenario.arbitrator.take_over.lead_s;
  scenario.arbitrator.take_over.absent_probability = 0.3;
  bool clean = true;
  for (const char* policy : {"traded", "blend"}) {
    scenario.arbitrator.policy = test::FindPolicy(policy).value();
    for (scenario.seed = 1; scenario.seed <= 10; ++scenario.seed) {
      std::int64_t steps = 0;
      clean = LoopAllocations(scenario, steps) == 0 && steps > 100 && clean;
    }
  }
  std::printf("take-over: %s\n", clean ? "0 allocations" : "it allocates");
  return clean;
}

bool Check() {
  bool clean = CheckController();
  clean = CheckModels() && clean;
  const std::vector<Shipped> all = ShippedScenarios(FOGLINE_SOURCE_DIR "/scenario");
  for (const Shipped& shipped : all) {
    clean = CheckLoop(shipped) && CheckTraffic(shipped) && clean;
    clean = CheckTakeOver(shipped.scenario) && clean;
  }
  clean = CheckHuman(all.front().scenario) && clean;
  // The set-up of the runs allocates memory, so a count of 0 means that the counter is broken.
  return clean && all.size() >= 2 && allocations > 0;
}

}  // namespace
}  // namespace fogline::test

int main() { return fogline::test::Check() ? 0 : 1; }
