// Tests which runs may share steps. tests/property compares the messages of such runs.
#include "services/closed_loop/shared_runs.h"

#include <gtest/gtest.h>

#include "scenario/io/loader.h"

namespace fogline::closed_loop {
namespace {

/// The paper's scenario without and with traded control.
struct Pair {
  Scenario without =
      LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json", {"/arbitrator/policy=none"});
  Scenario with = LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json");
};

TEST(SharedRunsTest, RunsThatDifferOnlyInTheArbitratorMayShareSteps) {
  Pair pair;
  EXPECT_TRUE(MayShareSteps(pair.without, pair.with));
  pair.with.arbitrator.threshold = 0.9;
  pair.with.arbitrator.window_steps = 3;
  EXPECT_TRUE(MayShareSteps(pair.without, pair.with));
  pair.with.seed += 1;
  EXPECT_FALSE(MayShareSteps(pair.without, pair.with));
}

TEST(SharedRunsTest, RunsWithCarsOfSumoShareStepsOnlyIfTheyAreEqual) {
  Pair pair;
  for (Scenario* scenario : {&pair.without, &pair.with}) {
    scenario->lead.profile = LeadProfile::kSumo;
  }
  EXPECT_FALSE(MayShareSteps(pair.without, pair.with));
  EXPECT_TRUE(MayShareSteps(pair.with, pair.with));
}

TEST(SharedRunsTest, RunsWhosePolicySelectsSensorsShareStepsOnlyIfTheyAreEqual) {
  Pair pair;
  pair.with =
      LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json", {"/arbitrator/policy=isolate"});
  EXPECT_FALSE(MayShareSteps(pair.without, pair.with));
  EXPECT_FALSE(MayShareSteps(pair.with, pair.without));
  EXPECT_TRUE(MayShareSteps(pair.with, pair.with));
}

}  // namespace
}  // namespace fogline::closed_loop
