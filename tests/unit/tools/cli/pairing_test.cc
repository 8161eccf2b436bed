#include "tools/cli/pairing.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "services/metrics/run_metrics.h"
#include "tests/unit/tools/short_run.h"

namespace fogline::test {
namespace {

constexpr std::int64_t kSteps = 500;  // some of them in fog

class PairingTest : public testing::Test {
 protected:
  runner::LoggedRun Run(const std::vector<std::string>& overrides) {
    const std::string log = folder_.File(std::to_string(++logs_) + ".lcm");
    runner::RunExperiment(Paper(kSteps, overrides), Direct(log));
    return runner::ReadLoggedRun(log);
  }
  const ScratchFolder folder_;
  int logs_ = 0;
};

TEST_F(PairingTest, OfARunIsTheSameScenarioWithoutTradedControl) {
  const Scenario traded = Paper(kSteps, {"/arbitrator/threshold=0.5"});
  Scenario paired = cli::WithoutTradedControl(traded);
  EXPECT_EQ(paired.arbitrator.policy, Policy::kNone);
  paired.arbitrator.policy = traded.arbitrator.policy;
  EXPECT_EQ(PrintScenario(paired), PrintScenario(traded));
}

TEST_F(PairingTest, GivesASafetyImprovementToEachRunThatHasItsPair) {
  const std::string none = "/arbitrator/policy=none";
  const std::vector<runner::LoggedRun> runs{
      Run({"/arbitrator/threshold=0.3"}),
      Run({none}),
      Run({"/arbitrator/threshold=0.3", "/seed=2"}),
  };
  const auto improvements = cli::SafetyImprovements(runs);
  ASSERT_EQ(improvements.size(), 3U);
  ASSERT_TRUE(improvements[0]);
  EXPECT_EQ(improvements[0],
            metrics::SafetyImprovementPct(runs[1].result.samples, runs[0].result.samples,
                                          runs[0].scenario.measures.safety_floor_m));
  EXPECT_EQ(improvements[1], std::nullopt) << "it is the pair";
  EXPECT_EQ(improvements[2], std::nullopt) << "its pair has another seed";
  EXPECT_TRUE(cli::SafetyImprovements({}).empty());
}

}  // namespace
}  // namespace fogline::test
