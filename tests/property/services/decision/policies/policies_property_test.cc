// Rules that hold with every policy, with every transfer profile and for any inputs.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/random.h"
#include "scenario/sections/decision.h"
#include "services/arbitrator/arbitrator.h"
#include "services/decision/policies/policies.h"
#include "services/fusion/fusion.h"
#include "tests/property/services/acc/draw.h"

namespace fogline::test {
namespace {

constexpr double kRounding = 1e-9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Enum>
Enum AnyChoice(Draw& draw) {
  return static_cast<Enum>(
      draw.Integer(0, static_cast<std::int64_t>(ChoiceNames<Enum>::kNames.size()) - 1));
}

TransferSection AnyTransfer(Draw& draw) {
  return {.profile = AnyChoice<TransferProfile>(draw),
          .duration_s = draw.LogUniform(0.05, 10),
          .jerk_mps3 = draw.LogUniform(0.1, 20),
          .yield_mps2 = draw.Uniform(1, 8),
          .hysteresis = AnyChoice<Hysteresis>(draw),
          .band = draw.Uniform(0, 0.5),
          .sprt_alpha = draw.LogUniform(1e-4, 0.4),
          .sprt_beta = draw.LogUniform(1e-4, 0.4),
          .min_dwell_s = draw.Chance(0.5) ? 0 : draw.Uniform(0, 3),
          .gate = draw.Chance(0.5),
          .gate_s = draw.Uniform(0.1, 4),
          .gate_acceleration_mps2 = draw.Uniform(0.3, 3),
          .gate_jerk_mps3 = draw.LogUniform(0.1, 5)};
}

Scenario AnyScenario(Draw& draw, Policy policy) {
  Scenario scenario;
  ArbitratorSection& section = scenario.arbitrator;
  scenario.step_s = draw.Uniform(0.02, 0.2);
  section.policy = policy;
  section.threshold = draw.Uniform(0, 1);
  section.window_steps = draw.Integer(1, 10);
  section.missing_lidar = AnyChoice<MissingLidar>(draw);
  section.measure = AnyChoice<MeasureChoice>(draw);
  section.measure_slope = draw.LogUniform(0.01, 100);
  section.blame = AnyChoice<BlameChoice>(draw);
  section.blame_threshold = draw.Uniform(0.3, 1);
  section.transfer = AnyTransfer(draw);
  return scenario;
}

/// The messages of a step, with any values that the network code accepts.
struct Inputs {
  truth_t truth{};
  ego_t ego{};
  radar_t radar{};
  lidar_t lidar{};
  accel_command_t automation{};
  driver_command_t driver{};

  void Next(Draw& draw, std::int64_t step) {
    ego.header.step = radar.header.step = lidar.header.step = step;
    const double gap_m = draw.Uniform(0, 80);
    truth.host_gap_m = gap_m;
    truth.fog_visibility_m = draw.LogUniform(1, 1e5);
    truth.num_followers = draw.Chance(0.9) ? 1 : 0;
    truth.follower_gap_m.assign(static_cast<std::size_t>(truth.num_followers),
                                draw.Uniform(-1, 60));
    truth.follower_speed_mps.assign(static_cast<std::size_t>(truth.num_followers),
                                    draw.Uniform(0, 40));
    ego.speed_mps = draw.Uniform(0, 40);
    ego.acceleration_mps2 = draw.Uniform(-6, 3);
    radar.valid = draw.Chance(0.9);
    radar.range_m = radar.valid ? gap_m + draw.Uniform(-1, 1) : 0;
    radar.range_std_m = radar.valid ? draw.LogUniform(0.001, 1) : 0;
    lidar.valid = draw.Chance(0.9);
    lidar.range_m = lidar.valid ? (draw.Chance(0.3) ? 4 : gap_m) + draw.Uniform(-0.1, 0.1) : 0;
    lidar.range_std_m = lidar.valid ? draw.LogUniform(0.001, 1) : 0;
    automation.acceleration_mps2 = draw.Uniform(-3, 2);
    driver.acceleration_mps2 = draw.Uniform(-9, 3);
    driver.readiness = draw.Uniform(0, 1);
  }
};

class EveryPolicyProperty : public testing::TestWithParam<std::size_t> {
 protected:
  Policy policy() const { return static_cast<Policy>(GetParam()); }
};

TEST_P(EveryPolicyProperty, AuthoritiesSumToOneAndTheCommandLiesBetweenTheOffersOrOnItsWay) {
  Draw draw(1 + static_cast<std::int64_t>(GetParam()));
  for (int run = 0; run < 60; ++run) {
    const Scenario scenario = AnyScenario(draw, policy());
    arbitrator::Arbitrator arbitrator(scenario);
    fusion::Fusion fusion(scenario);
    Inputs in;
    double previous = 0;
    for (std::int64_t k = 0; k < 100; ++k) {
      in.Next(draw, k);
      arbitrator.SetOnDemandInput(in.truth);
      fusion.SetOnDemandInput(in.truth);
      const track_t& track = fusion.Step(in.ego, in.radar, in.lidar);
      const arbitration_t& out =
          arbitrator.Step(in.ego, in.radar, in.lidar, track, in.automation, in.driver);
      ASSERT_TRUE(std::isfinite(out.acceleration_mps2) && std::isfinite(out.conflict_m) &&
                  std::isfinite(track.state[0]));
      ASSERT_GE(out.lambda_human, 0);
      ASSERT_GE(out.lambda_automation, 0);
      ASSERT_EQ(out.lambda_human + out.lambda_automation, 1);
      ASSERT_GE(out.doc, 0);
      ASSERT_LE(out.doc, 1);
      ASSERT_GE(out.threshold, 0);
      ASSERT_LE(out.threshold, 1);
      ASSERT_EQ(out.mode == arbitration_t::HUMAN, out.lambda_human >= 0.5);
      // The command lies in the range of the two offers and the previous command. If a command is
      // beyond the gate's limit, the gate replaces the command by this limit. The limit may be
      // outside of the range.
      const TransferSection& transfer = scenario.arbitrator.transfer;
      const double gate_mps2 = transfer.gate ? transfer.gate_acceleration_mps2 : kInfinity;
      const auto [low, high] =
          std::minmax({in.automation.acceleration_mps2, in.driver.acceleration_mps2,
                       k == 0 ? in.ego.acceleration_mps2 : previous});
      ASSERT_GE(out.acceleration_mps2, std::min(low, gate_mps2) - kRounding);
      ASSERT_LE(out.acceleration_mps2, std::max(high, -gate_mps2) + kRounding);
      previous = out.acceleration_mps2;
    }
  }
}

TEST_P(EveryPolicyProperty, DecidesTheSameAgain) {
  Draw scenarios(100 + static_cast<std::int64_t>(GetParam()));
  for (int run = 0; run < 10; ++run) {
    const Scenario scenario = AnyScenario(scenarios, policy());
    std::vector<arbitration_t> decided[2];
    for (auto& decisions : decided) {
      Draw draw(run);
      arbitrator::Arbitrator arbitrator(scenario);
      fusion::Fusion fusion(scenario);
      Inputs in;
      for (std::int64_t k = 0; k < 50; ++k) {
        in.Next(draw, k);
        arbitrator.SetOnDemandInput(in.truth);
        fusion.SetOnDemandInput(in.truth);
        const track_t& track = fusion.Step(in.ego, in.radar, in.lidar);
        decisions.push_back(
            arbitrator.Step(in.ego, in.radar, in.lidar, track, in.automation, in.driver));
      }
    }
    for (std::size_t k = 0; k < 50; ++k) {
      ASSERT_EQ(decided[0][k].acceleration_mps2, decided[1][k].acceleration_mps2);
      ASSERT_EQ(decided[0][k].lambda_human, decided[1][k].lambda_human);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheTable, EveryPolicyProperty,
                         testing::Range<std::size_t>(0, ChoiceNames<Policy>::kNames.size()),
                         [](const auto& row) {
                           return std::string(ChoiceNames<Policy>::kNames[row.param]);
                         });

TEST(TransferProperty, ALimitedCommandNeverChangesFasterThanItsJerkAfterATransfer) {
  Draw draw(11);
  int limited = 0;
  for (int run = 0; run < 300; ++run) {
    // GIVEN constant offers and no emergency
    const bool gate = draw.Chance(0.5);
    const TransferSection section{.profile = TransferProfile::kJerkLimited,
                                  .jerk_mps3 = draw.LogUniform(0.1, 20),
                                  .yield_mps2 = 10,
                                  .gate = gate,
                                  .gate_s = draw.Uniform(0.1, 4),
                                  .gate_acceleration_mps2 = draw.Uniform(0.3, 3),
                                  .gate_jerk_mps3 = draw.LogUniform(0.1, 5)};
    const double step_s = draw.Uniform(0.02, 0.2);
    const double jerk_mps3 =
        gate ? std::min(section.jerk_mps3, section.gate_jerk_mps3) : section.jerk_mps3;
    const arbitrator::Transfer::Offers offers{.automation_mps2 = draw.Uniform(-3, 2),
                                              .human_mps2 = draw.Uniform(-9, 3)};
    arbitrator::Transfer transfer(section, step_s);
    double previous = offers.automation_mps2;
    double wanted = 0;
    // WHEN authority changes often
    for (int k = 0; k < 200; ++k) {
      if (draw.Chance(0.1)) wanted = 1 - wanted;
      const arbitrator::Transfer::State state = transfer.Step(wanted, offers, previous);
      // THEN no step exceeds the jerk limit, and the authority is the wanted authority
      ASSERT_LE(std::abs(state.acceleration_mps2 - previous), jerk_mps3 * step_s + kRounding);
      ASSERT_EQ(state.lambda_human, wanted);
      const double target = wanted == 0 ? offers.automation_mps2 : offers.human_mps2;
      limited += state.acceleration_mps2 != target ? 1 : 0;
      previous = state.acceleration_mps2;
    }
  }
  EXPECT_GT(limited, 1000) << "the limit was in force";
}

TEST(TransferProperty, ARampChangesAuthorityNoFasterThanItsSteepestPart) {
  Draw draw(12);
  for (int run = 0; run < 300; ++run) {
    const bool sigmoid = draw.Chance(0.5);
    const TransferSection section{
        .profile = sigmoid ? TransferProfile::kSigmoid : TransferProfile::kLinear,
        .duration_s = draw.Uniform(0.5, 5)};
    const double step_s = draw.Uniform(0.02, 0.2);
    // The largest slope of the ramp: 1 if it is linear, S'(1/2) for the sigmoid S of
    // services/arbitrator/transfer.h. S'(1/2) = k/4 / (1 - 2 s(-k/2)), with k = 10 and s(x) = 1/(1
    // + e^-x).
    const double steepest = sigmoid ? 2.5 / (1 - 2 / (1 + std::exp(5.0))) : 1;
    arbitrator::Transfer transfer(section, step_s);
    double previous = 0;
    double wanted = 0;
    for (int k = 0; k < 200; ++k) {
      if (draw.Chance(0.1)) wanted = draw.Uniform(0, 1);
      const double lambda = transfer.Step(wanted, {-1, 1}, 0).lambda_human;
      ASSERT_LE(std::abs(lambda - previous), steepest * step_s / section.duration_s + kRounding);
      ASSERT_GE(lambda, 0);
      ASSERT_LE(lambda, 1);
      previous = lambda;
    }
  }
}

TEST(RequestDebouncerProperty, NoTwoTransfersAreNearerThanTheLeastStay) {
  Draw draw(13);
  int transfers = 0;
  for (int run = 0; run < 200; ++run) {
    TransferSection section = AnyTransfer(draw);
    const double step_s = draw.Uniform(0.02, 0.2);
    arbitrator::RequestDebouncer debouncer(section, step_s);
    double previous = 0;
    std::optional<int> last;
    for (int k = 0; k < 300; ++k) {
      const double doc = draw.Uniform(0, 1);
      const double wanted = debouncer.Step(policies::Compare(doc, draw.Uniform(0.4, 0.6)), doc);
      ASSERT_TRUE(wanted == 0 || wanted == 1);
      if (wanted != previous) {
        if (last) {
          ASSERT_GE((k - *last) * step_s, section.min_dwell_s - kRounding);
        }
        last = k;
        ++transfers;
      }
      previous = wanted;
    }
  }
  EXPECT_GT(transfers, 1000);
}

// Wald's sequential test (hysteresis `sprt`) keeps the error rates that its parameters allow, if
// the DoC really is the probability of a conflict. Here a reading x comes from N(m, 1) if there is
// a conflict, and from N(-m, 1) if there is no conflict. If both cases are equally likely, the
// probability of a conflict is 1/(1 + e^(-2mx)).
TEST(RequestDebouncerProperty, SprtErrsNoMoreOftenThanItsParametersSay) {
  constexpr int kTests = 20'000;
  constexpr double kMean = 0.3;
  for (const double alpha : {0.01, 0.1}) {
    const Random random(14, Stream::kRadar);
    int errors = 0;
    for (int test = 0; test < kTests; ++test) {
      arbitrator::RequestDebouncer debouncer(
          {.hysteresis = Hysteresis::kSprt, .sprt_alpha = alpha, .sprt_beta = alpha}, 0.1);
      // GIVEN no conflict WHEN Wald's test runs until its first decision, or for 60 steps THEN at
      // most about a share alpha of the tests decides for the human
      for (int k = 0; k < 60; ++k) {
        const double x = random.Normal2(test, static_cast<std::uint32_t>(k))[0] - kMean;
        const double doc = 1 / (1 + std::exp(-2 * kMean * x));
        const double before = debouncer.evidence();
        if (debouncer.Step(policies::Compare(doc, 0.5), doc) == 1) {
          ++errors;
          break;
        }
        if (before != 0 && debouncer.evidence() == 0) break;  // decided for the automation
      }
    }
    // Wald's bound for the share of wrong decisions is alpha/(1 - beta); here beta = alpha. The
    // tolerance is four standard deviations of the count.
    const double bound = alpha / (1 - alpha);
    EXPECT_LE(errors, kTests * bound + 4 * std::sqrt(kTests * bound)) << alpha;
    EXPECT_GT(errors, 0) << alpha;
  }
}

}  // namespace
}  // namespace fogline::test
