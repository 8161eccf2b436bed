// The role that drives the following cars stops sending. The tests check that all these cars stop.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "tests/property/fallback/real_time_loop.h"

namespace fogline {
namespace {

using test::kRounding;
using test::Moment;
using test::RealTimeLoop;

constexpr std::size_t kCars = 5;
constexpr std::int64_t kUntilFallback = 4;  // periods from the last command to the fallback

/// The paper's scenario with five cars behind the host. An ACC or a human driver drives each of the
/// five cars.
Scenario Column() {
  Scenario scenario =
      LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json", {"/world/end_on_collision=false"});
  scenario.followers.count = kCars;
  scenario.followers.driver = FollowerDriver::kDrawn;
  scenario.followers.style = FollowerStyle::kDrawn;
  return scenario;
}

TEST(SilentFollowersTest, EachStopsWithinTheLimitsAndTheHostGoesOn) {
  const Scenario scenario = Column();
  const double change_mps2 = scenario.minimal_risk.jerk_mps3 * scenario.step_s + kRounding;
  for (std::int64_t death = 0; death < 200; death += 17) {
    SCOPED_TRACE("silent from step " + std::to_string(death));
    RealTimeLoop loop(scenario);
    loop.Silence(Role::kFollower, death);
    std::array<double, kCars> last_mps2{};
    std::array<bool, kCars> stands{};
    double host_mps = 0;
    loop.Run([&](const Moment& m) {
      const std::int64_t step = m.truth.header.step;
      for (std::size_t car = 0; car < kCars; ++car) {
        const double applied_mps2 = m.truth.follower_acceleration_mps2[car];
        if (step > death + kUntilFallback) {
          ASSERT_TRUE(m.vehicle.follower_in_minimal_risk());
          ASSERT_LE(std::abs(applied_mps2 - last_mps2[car]), change_mps2) << "car " << car;
          ASSERT_GE(applied_mps2,
                    std::min(-scenario.minimal_risk.deceleration_mps2, last_mps2[car]) - kRounding)
              << "car " << car;
        }
        last_mps2[car] = applied_mps2;
        stands[car] = m.truth.follower_speed_mps[car] == 0;
      }
      host_mps = m.truth.host_speed_mps;
      ASSERT_FALSE(m.vehicle.host_in_minimal_risk());
    });
    if (HasFatalFailure()) return;
    EXPECT_TRUE(std::ranges::all_of(stands, [](bool one) { return one; }));
    EXPECT_GT(host_mps, 10);
  }
}

TEST(SilentFollowersTest, WithoutASilentFollowerIsTheLockstepRun) {
  const Scenario scenario = Column();
  world::World lockstep(scenario);
  follower::Follower follower(scenario);
  lockstep.Start(1);
  RealTimeLoop(scenario).Run([&](const Moment& m) {
    // GIVEN a run in lockstep with the same commands to the host, THEN the commands of the
    // followers are equal in this run and in the run in lockstep
    const follower_command_t& command = follower.Step(lockstep.truth());
    ASSERT_EQ(m.truth.follower_position_m, lockstep.truth().follower_position_m);
    ASSERT_EQ(m.vehicle.followers().acceleration_mps2, command.acceleration_mps2);
    if (!m.truth.last) lockstep.Step(m.carried_out, command);
  });
}

}  // namespace
}  // namespace fogline
