// Checks that no step of the ACC allocates memory, whichever path it takes. A program of its own,
// because it replaces malloc. Exits with 1 and says what allocated.
#include <cstddef>
#include <cstdio>

#include "services/acc/acc_controller.h"
#include "services/follower/follower.h"
#include "tests/property/acc/draw.h"

// The C library's own, which the replacement below calls.
extern "C" void* __libc_malloc(std::size_t size);  // NOLINT(bugprone-reserved-identifier)

namespace {
long allocations = 0;
}  // namespace

extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace fogline {
namespace {

// Allocations during random steps with and without target, calm and hopeless. Counts the steps in
// which the solver ran.
long ControllerAllocations(int& solver_steps) {
  Draw draw(1);
  AccController acc(AccSection{}, 0.1);
  const long before = allocations;
  for (int k = 0; k < 5000; ++k) {
    const double scale = draw.LogUniform(0.01, 1);
    const AccController::Output output =
        acc.Step({.distance_m = 33 + scale * draw.Uniform(-33, 60),
                  .relative_speed_mps = scale * draw.Uniform(-15, 15),
                  .speed_mps = 20 + scale * draw.Uniform(-20, 30),
                  .acceleration_mps2 = scale * draw.Uniform(-8, 5),
                  .has_target = draw.Chance(0.9)});
    if (output.solver == AccController::Solver::kActiveSet) ++solver_steps;
  }
  return allocations - before;
}

long FollowerAllocations() {
  Follower follower{Scenario()};
  truth_t truth{};
  truth.num_followers = 1;
  truth.host_speed_mps = 20;
  truth.follower_speed_mps = {20};
  truth.follower_acceleration_mps2 = {0};
  truth.follower_gap_m = {30};
  follower.Step(truth);
  const long before = allocations;
  for (int k = 0; k < 100; ++k) follower.Step(truth);
  return allocations - before;
}

bool Check() {
  int solver_steps = 0;
  const long controller = ControllerAllocations(solver_steps);
  const long follower = FollowerAllocations();
  std::printf("allocations: controller %ld (%d steps with solver), follower %ld, in all %ld\n",
              controller, solver_steps, follower, allocations);
  // A program without any allocation would not be counting.
  return controller == 0 && follower == 0 && solver_steps > 1000 && allocations > 0;
}

}  // namespace
}  // namespace fogline

int main() { return fogline::Check() ? 0 : 1; }
