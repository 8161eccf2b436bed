// Hand-overs in the whole loop: what a smooth one is worth, and what it costs; and that the
// automation comes back without a bump.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenario/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "services/measures/measures.h"

namespace fogline::test {
namespace {

constexpr double kSmooth_mps3 = 2.5;  // ISO 15622 above 20 m/s

Scenario Paper() { return LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json"); }

Scenario DenseFog() { return LoadScenario(FOGLINE_SOURCE_DIR "/scenario/dense_fog.json"); }

std::vector<Sample> SamplesOf(const Scenario& scenario) {
  std::vector<Sample> samples;
  ClosedLoop(scenario).Run(0, [&](const StepView& step) { samples.push_back(step.ToSample()); });
  return samples;
}

struct Outcome {
  double max_jerk_mps3 = 0;       // of the command, in any step
  double handover_jerk_mps3 = 0;  // of the command, in the step of a hand-over
  double si_pct = 0;
};

/// Of the seeds 1 to `seeds`: the largest jerks of all, the mean of SI.
Outcome OutcomeOf(Scenario scenario, int seeds) {
  Outcome outcome;
  for (scenario.seed = 1; scenario.seed <= seeds; ++scenario.seed) {
    Scenario pair = scenario;
    pair.arbitrator.policy = Policy::kNone;
    const std::vector<Sample> run = SamplesOf(scenario);
    for (std::size_t k = 1; k < run.size(); ++k) {
      outcome.max_jerk_mps3 =
          std::max(outcome.max_jerk_mps3,
                   std::abs(run[k].command_mps2 - run[k - 1].command_mps2) / scenario.step_s);
    }
    outcome.handover_jerk_mps3 =
        std::max(outcome.handover_jerk_mps3, Measure(run).max_handover_jump_mps2 / scenario.step_s);
    outcome.si_pct +=
        *SafetyImprovementPct(SamplesOf(pair), run, scenario.measures.safety_floor_m) / seeds;
  }
  return outcome;
}

constexpr TransferProfile kProfiles[] = {TransferProfile::kLinear, TransferProfile::kSigmoid,
                                         TransferProfile::kJerkLimited};

// The paper's experiment jumps by a few cm/s2 only: 0.3 to 0.4 m/s3, below the limit as it is. What
// a profile must not do there is cost safety.
TEST(SmoothTransferProperty, EveryProfileIsSmoothInThePapersExperimentForThreePointsOfSafety) {
  for (const int seeds : {1, 40}) {
    Scenario scenario = Paper();
    ASSERT_EQ(scenario.arbitrator.threshold, 0.5);
    const Outcome abrupt = OutcomeOf(scenario, seeds);
    for (const TransferProfile profile : kProfiles) {
      scenario.arbitrator.transfer.profile = profile;
      const Outcome smooth = OutcomeOf(scenario, seeds);
      EXPECT_LE(smooth.max_jerk_mps3, abrupt.max_jerk_mps3);
      EXPECT_LE(smooth.max_jerk_mps3, kSmooth_mps3);
      EXPECT_GE(smooth.si_pct, abrupt.si_pct - 3) << static_cast<int>(profile);
      if (profile != TransferProfile::kJerkLimited) {
        EXPECT_LE(smooth.max_jerk_mps3, 0.8 * abrupt.max_jerk_mps3) << "a ramp shows even here";
      }
    }
  }
}

// Where the fog makes the automation brake, the paper's hand-over jumps by more than 1 m/s2.
TEST(SmoothTransferProperty, ALimitedCommandTakesTheJerkOutOfHandOversInDenseFogForNothing) {
  Scenario scenario = DenseFog();
  const Outcome abrupt = OutcomeOf(scenario, 20);
  EXPECT_GT(abrupt.handover_jerk_mps3, 10);
  scenario.arbitrator.transfer.profile = TransferProfile::kJerkLimited;
  const Outcome limited = OutcomeOf(scenario, 20);
  EXPECT_LE(limited.handover_jerk_mps3, scenario.arbitrator.transfer.jerk_mps3 + 1e-9);
  EXPECT_GE(limited.si_pct, abrupt.si_pct - 3);
  scenario.arbitrator.transfer.gate = true;
  const Outcome gated = OutcomeOf(scenario, 20);
  EXPECT_LE(gated.handover_jerk_mps3, scenario.arbitrator.transfer.gate_jerk_mps3 + 1e-9);
  EXPECT_GE(gated.si_pct, abrupt.si_pct - 3);
}

// The ACC plans from the acceleration that the host really has: with every hand-back its command is
// within the engine's share of one change of u of what the human had commanded, jump or no jump.
TEST(BumplessTransferProperty, TheAutomationReturnsFromTheAccelerationThatTheHostHas) {
  int returns = 0;
  for (const char* file : {"/scenario/paper.json", "/scenario/dense_fog.json"}) {
    Scenario scenario = LoadScenario(FOGLINE_SOURCE_DIR + std::string(file));
    const double share = -std::expm1(-scenario.step_s / scenario.acc.engine_time_constant_s);
    const double bump_mps2 = share * scenario.acc.max_jerk_mps3 * scenario.step_s;
    for (scenario.seed = 1; scenario.seed <= 10; ++scenario.seed) {
      const std::vector<Sample> run = SamplesOf(scenario);
      for (std::size_t k = 1; k < run.size(); ++k) {
        if (run[k - 1].lambda_human == 0 || run[k].lambda_human > 0) continue;
        const double human_mps2 = run[k - 1].command_mps2;
        const double outside_mps2 =
            std::abs(human_mps2 - std::clamp(human_mps2, scenario.acc.min_acceleration_mps2,
                                             scenario.acc.max_acceleration_mps2));
        EXPECT_LE(std::abs(run[k].command_mps2 - human_mps2),
                  bump_mps2 + share * outside_mps2 + 1e-9)
            << file << " seed " << scenario.seed << " step " << k;
        ++returns;
      }
    }
  }
  EXPECT_GE(returns, 20);
}

}  // namespace
}  // namespace fogline::test
