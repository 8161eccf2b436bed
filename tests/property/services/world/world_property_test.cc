// Properties of whole runs under random commands.
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "services/world/world.h"
#include "tests/unit/services/world/commands.h"

namespace fogline {
namespace {

constexpr int kRuns = 50;

struct Commands {
  double host_mps2;
  double follower_mps2;
};

// Random commands for hard driving. In many runs they lead to stops and collisions.
std::vector<Commands> RandomCommands(std::uint64_t seed, std::int64_t steps) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> acceleration(-6.0, 5.0);
  std::vector<Commands> commands(static_cast<std::size_t>(steps));
  double host = 0.0;
  double follower = 0.0;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (i % 10 == 0) host = acceleration(engine);
    if (i % 10 == 5) follower = acceleration(engine);
    commands[i] = {host, follower};
  }
  return commands;
}

Scenario Rough() {
  Scenario scenario;
  scenario.steps = 300;
  scenario.world.end_on_collision = false;
  scenario.lead.profile = LeadProfile::kSinusoid;
  scenario.lead.sinusoid.amplitude_mps = 25.0;  // the leader stands still for a part of each period
  return scenario;
}

std::vector<truth_t> Drive(const Scenario& scenario, std::uint64_t seed) {
  world::World world(scenario);
  std::vector<truth_t> truths{std::get<truth_t>(world.Start(1))};
  for (const Commands& command : RandomCommands(seed, scenario.steps - 1)) {
    truths.push_back(std::get<truth_t>(
        world.Step(HostCommand(command.host_mps2), FollowerCommand(command.follower_mps2))));
  }
  return truths;
}

TEST(WorldProperty, SpeedsAreNeverNegativeAndCarsNeverGoBackwards) {
  for (int run = 0; run < kRuns; ++run) {
    const auto truths = Drive(Rough(), static_cast<std::uint64_t>(run));
    for (std::size_t k = 1; k < truths.size(); ++k) {
      ASSERT_GE(truths[k].preceding_speed_mps, 0.0);
      ASSERT_GE(truths[k].host_speed_mps, 0.0);
      ASSERT_GE(truths[k].follower_speed_mps[0], 0.0);
      ASSERT_GE(truths[k].preceding_position_m, truths[k - 1].preceding_position_m);
      ASSERT_GE(truths[k].host_position_m, truths[k - 1].host_position_m);
      ASSERT_GE(truths[k].follower_position_m[0], truths[k - 1].follower_position_m[0]);
    }
  }
}

TEST(WorldProperty, AccelerationIsTheChangeOfSpeed) {
  for (int run = 0; run < kRuns; ++run) {
    const auto truths = Drive(Rough(), static_cast<std::uint64_t>(run));
    for (std::size_t k = 1; k < truths.size(); ++k) {
      // A relative rounding of 1e-12 at 60 m/s, divided by the step of 0.1 s.
      constexpr double kTolerance_mps2 = 1e-12 * 60.0 / 0.1;
      ASSERT_NEAR(truths[k].host_acceleration_mps2,
                  (truths[k].host_speed_mps - truths[k - 1].host_speed_mps) / 0.1, kTolerance_mps2);
      ASSERT_NEAR(truths[k].follower_acceleration_mps2[0],
                  (truths[k].follower_speed_mps[0] - truths[k - 1].follower_speed_mps[0]) / 0.1,
                  kTolerance_mps2);
    }
  }
}

TEST(WorldProperty, SubstepsChangeNothingButRounding) {
  Scenario fine = Rough();
  fine.world.substeps = 16;
  int collisions = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto coarse_truths = Drive(Rough(), static_cast<std::uint64_t>(run));
    const auto fine_truths = Drive(fine, static_cast<std::uint64_t>(run));
    for (std::size_t k = 0; k < coarse_truths.size(); ++k) {
      const truth_t& a = coarse_truths[k];
      const truth_t& b = fine_truths[k];
      // The tolerance covers 300 steps with 16 roundings each, on positions up to 1 km.
      ASSERT_NEAR(a.host_position_m, b.host_position_m, 1e-9);
      ASSERT_NEAR(a.host_speed_mps, b.host_speed_mps, 1e-11);
      ASSERT_NEAR(a.preceding_position_m, b.preceding_position_m, 1e-9);
      ASSERT_NEAR(a.follower_gap_m[0], b.follower_gap_m[0], 1e-9);
      ASSERT_EQ(a.collision, b.collision);
      // In these runs the gap closes with at least some millimetres per second. So rounding of the
      // gap by 1e-9 m changes the time by less than 1e-6 s.
      ASSERT_NEAR(a.collision_time_s, b.collision_time_s, 1e-6);
    }
    if (coarse_truths.back().collision != truth_t::COLLISION_NONE) ++collisions;
  }
  EXPECT_GT(collisions, kRuns / 4) << "the runs must have collisions to say something";
}

TEST(WorldProperty, TheCollisionLiesInTheStepThatFirstReportsIt) {
  for (int run = 0; run < kRuns; ++run) {
    const auto truths = Drive(Rough(), static_cast<std::uint64_t>(run));
    for (std::size_t k = 1; k < truths.size(); ++k) {
      if (truths[k].collision == truth_t::COLLISION_NONE) {
        ASSERT_GT(truths[k].host_gap_m, 0.0);
        ASSERT_GT(truths[k].follower_gap_m[0], 0.0);
        continue;
      }
      EXPECT_GE(truths[k].collision_time_s, static_cast<double>(truths[k - 1].header.utime) / 1e6);
      EXPECT_LE(truths[k].collision_time_s, static_cast<double>(truths[k].header.utime) / 1e6);
      break;
    }
  }
}

TEST(WorldProperty, EqualCommandsGiveEqualRuns) {
  const auto a = Drive(Rough(), 7);
  const auto b = Drive(Rough(), 7);
  for (std::size_t k = 0; k < a.size(); ++k) {
    std::vector<std::uint8_t> bytes_a(static_cast<std::size_t>(a[k].getEncodedSize()));
    std::vector<std::uint8_t> bytes_b(static_cast<std::size_t>(b[k].getEncodedSize()));
    a[k].encode(bytes_a.data(), 0, a[k].getEncodedSize());
    b[k].encode(bytes_b.data(), 0, b[k].getEncodedSize());
    ASSERT_EQ(bytes_a, bytes_b) << "step " << k;
  }
}

}  // namespace
}  // namespace fogline
