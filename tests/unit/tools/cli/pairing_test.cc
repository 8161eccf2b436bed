#include "tools/cli/pairing.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "services/metrics/safety_improvement.h"
#include "tests/unit/tools/short_run.h"

namespace fogline::test {
namespace {

constexpr std::int64_t kSteps = 500;  // some of them in fog

class PairingTest : public testing::Test {
 protected:
  runner::LoggedRun Run(const std::vector<std::string>& overrides) {
    const std::string log = folder_.File(std::to_string(++logs_) + ".lcm");
    runner::RunScenario(Paper(kSteps, overrides), Direct(log));
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

TEST_F(PairingTest, MeasuresEachRunThatHasItsPair) {
  const std::string none = "/arbitrator/policy=none";
  const std::vector<runner::LoggedRun> runs{
      Run({"/arbitrator/threshold=0.3"}),
      Run({none}),
      Run({"/arbitrator/threshold=0.3", "/seed=2"}),
  };
  const std::vector<cli::Pairing> pairs = cli::MeasurePairs(runs);
  ASSERT_EQ(pairs.size(), 3U);
  ASSERT_TRUE(pairs[0].measures.si_pct);
  EXPECT_EQ(pairs[0].measures.si_pct,
            metrics::SafetyImprovementPct(runs[1].result.samples, runs[0].result.samples,
                                          runs[0].scenario.measures.safety_floor_m));
  EXPECT_TRUE(pairs[0].measures.si_until_recovery_pct);
  EXPECT_EQ(pairs[0].without.mean_compromised_safety_m,
            runs[1].result.measures.mean_compromised_safety_fog_m);
  EXPECT_EQ(pairs[0].without.slow_down_mps, runs[1].result.measures.max_slow_down_fog_mps);
  EXPECT_EQ(pairs[1].measures.si_pct, std::nullopt) << "it is the pair";
  EXPECT_EQ(pairs[2].measures.si_pct, std::nullopt) << "its pair has another seed";
  EXPECT_EQ(pairs[2].measures.si_until_recovery_pct, std::nullopt);
  EXPECT_TRUE(cli::MeasurePairs({}).empty());
}

}  // namespace
}  // namespace fogline::test
