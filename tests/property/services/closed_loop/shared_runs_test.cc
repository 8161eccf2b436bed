// Runs that share steps have the same messages as runs that share nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "services/closed_loop/shared_runs.h"
#include "tests/property/services/closed_loop/drawn_scenario.h"
#include "tests/property/services/closed_loop/shipped.h"

namespace fogline::test {
namespace {

/// The digest of each run of a call of SharedRuns::Run(), and how many steps the runs shared.
struct Digests {
  std::vector<std::string> of_runs;
  std::int64_t steps = 0;
  std::int64_t shared = 0;  // steps that were computed for another run, too
};

Digests DigestsOf(closed_loop::SharedRuns& runs, const std::vector<Scenario>& scenarios) {
  std::vector<runtime::Digest> digests(scenarios.size());
  std::vector<std::int64_t> next(scenarios.size(), 0);
  std::vector<std::uint8_t> buffer;
  Digests result;
  std::pair<const truth_t*, std::int64_t> last;  // object and step
  runs.Run(scenarios, [&](std::size_t run, const closed_loop::StepView& step) {
    EXPECT_EQ(step.truth.header.step, next[run]++) << "run " << run;
    step.ForEachMessage([&](const auto& message) {
      runtime::Encode(message, buffer);
      digests[run].Add(buffer);
    });
    ++result.steps;
    const std::pair shown(&step.truth, step.truth.header.step);
    if (shown == last) ++result.shared;
    last = shown;
  });
  for (runtime::Digest& digest : digests) result.of_runs.push_back(digest.Hex());
  return result;
}

TEST(SharedRunsProperty, HaveTheMessagesOfRunsThatShareNothing) {
  Draw draw(1);
  Scenario scenario;
  closed_loop::SharedRuns runs;
  std::int64_t steps = 0;
  std::int64_t shared = 0;
  std::map<std::string, int> times;  // how often each digest came
  for (int i = 0; i < 40; ++i) {
    // GIVEN scenarios of which most differ only in the arbitrator
    ChangeScenario(draw, scenario);
    std::vector<Scenario> scenarios;
    const std::int64_t count = draw.Integer(1, 6);
    while (std::ssize(scenarios) < count) {
      scenarios.push_back(scenario);
      ChangeArbitrator(draw, scenarios.back());
      if (draw.Chance(0.1)) scenarios.back().seed += 1;
    }
    // WHEN they run together
    const Digests together = DigestsOf(runs, scenarios);
    // THEN every message has the same bits as in a run alone
    for (std::size_t run = 0; run < scenarios.size(); ++run) {
      const std::string alone = FreshDigest(scenarios[run]);
      EXPECT_EQ(together.of_runs[run], alone) << "round " << i << ", run " << run;
      ++times[alone];
    }
    steps += together.steps;
    shared += together.shared;
  }
  EXPECT_GT(times.size(), 60U) << "the runs differ, so equality says something";
  EXPECT_GT(shared, steps / 20);
  EXPECT_LT(shared, steps * 9 / 10);
}

TEST(SharedRunsProperty, HaveTheMessagesOfEveryShippedScenario) {
  closed_loop::SharedRuns runs;
  for (const Shipped& shipped : ShippedScenarios(FOGLINE_SOURCE_DIR "/scenario")) {
    std::vector<Scenario> scenarios(4, shipped.scenario);
    scenarios[0].arbitrator.policy = Policy::kNone;
    scenarios[2].arbitrator.threshold = 0.1;
    scenarios[3].arbitrator.threshold = 0.9;
    const Digests together = DigestsOf(runs, scenarios);
    for (std::size_t run = 0; run < scenarios.size(); ++run) {
      EXPECT_EQ(together.of_runs[run], FreshDigest(scenarios[run])) << shipped.name << ", " << run;
    }
  }
}

TEST(SharedRunsProperty, ARequestEndsTheSharingIfTheDriverIsAwareOfIt) {
  // GIVEN a driver whose awareness depends on the mode, and an arbitrator that requests the driver
  // to take over. During the request the automation still drives, so at first the two runs differ
  // only in the mode. The driver notices the mode, so the runs share no step after the request
  std::vector<Scenario> scenarios(
      2, LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json",
                      {"/human/loses_awareness=true", "/arbitrator/take_over/mode=requested"}));
  scenarios[0].arbitrator.policy = Policy::kNone;
  closed_loop::SharedRuns runs;
  const Digests together = DigestsOf(runs, scenarios);
  for (std::size_t run = 0; run < scenarios.size(); ++run) {
    EXPECT_EQ(together.of_runs[run], FreshDigest(scenarios[run])) << run;
  }
  EXPECT_GT(together.shared, 150);
  EXPECT_LT(together.shared, 250);
}

TEST(SharedRunsProperty, ShareTheStepsBeforeTheHumanDrives) {
  // The human of the paper's experiment drives from step 203 on (threshold 0.5). So the two runs
  // share only the 203 steps before step 203.
  std::vector<Scenario> scenarios(2, LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json"));
  scenarios[0].arbitrator.policy = Policy::kNone;
  closed_loop::SharedRuns runs;
  const Digests together = DigestsOf(runs, scenarios);
  EXPECT_EQ(together.steps, 1000);
  EXPECT_EQ(together.shared, 203);
}

}  // namespace
}  // namespace fogline::test
