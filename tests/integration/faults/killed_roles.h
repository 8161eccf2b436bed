// Tests that kill or stop roles of runs, and expect the results of undisturbed runs.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "services/graph.h"
#include "tests/integration/faults/watched_run.h"

namespace fogline::test {

inline std::vector<std::string> AllRoles() {
  std::vector<std::string> names;
  for (const RoleInfo& info : kRoles) names.emplace_back(info.name);
  return names;
}

/// Stops these roles of a run. Expects that each role is killed, started again, and named in the
/// result.
inline void ExpectHangersAreStartedAgain(const std::vector<std::string>& roles) {
  WatchedRun watched({"--stall-timeout", "30"});
  watched.WaitForStep(100);
  for (const std::string& role : roles) watched.Signal(role, SIGSTOP);
  const auto result = watched.ExpectSameResult();
  ASSERT_EQ(result["restarts"].size(), roles.size());
  for (const std::string& role : roles) {
    EXPECT_EQ(WatchedRun::RestartsOf(result, role), 1) << role;
  }
  for (const auto& restart : result["restarts"]) {
    EXPECT_THAT(
        restart["last"].get<std::string>(),
        testing::MatchesRegex("was silent for [2-9]\\.[0-9] s and was killed at step [0-9]+"));
  }
}

/// Kills `wanted` processes at random steps, at most ten in each run. The run is not over when the
/// last process is killed.
inline void ExpectKillsAtRandomStepsChangeNoResult(int wanted) {
  constexpr int kKillsPerRun = 10;
  constexpr int kLastKill = kSteps - 100;
  std::mt19937 random(2024);
  const std::vector<std::string> roles = AllRoles();
  for (int done = 0; done < wanted;) {
    const int kills = std::min(kKillsPerRun, wanted - done);
    std::vector<int> steps(static_cast<std::size_t>(kills));
    for (int& step : steps) step = std::uniform_int_distribution(1, kLastKill)(random);
    std::ranges::sort(steps);
    WatchedRun watched;
    for (const int step : steps) {
      watched.WaitForStep(step);
      watched.Signal(roles[std::uniform_int_distribution<std::size_t>(0, roles.size() - 1)(random)],
                     SIGKILL);
    }
    const auto result = watched.ExpectSameResult();
    int restarts = 0;
    for (const auto& role : result["restarts"]) restarts += role["count"].get<int>();
    EXPECT_EQ(restarts, kills) << watched.run().Err();
    done += kills;
  }
}

}  // namespace fogline::test
