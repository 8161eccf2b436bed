#include "services/metrics/run_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/services/metrics/example_runs.h"

namespace fogline {
namespace {

TEST(CompromisedSafetyTest, IsTheShortfallOfTheSafeDistance) {
  metrics::Sample sample;
  sample.follower_safe_distance_m = 32;
  sample.follower_gap_m = 31.5;
  EXPECT_EQ(metrics::CompromisedSafety(sample), 0.5);
}

TEST(CompromisedSafetyTest, IsNeverNegative) {
  metrics::Sample sample;
  sample.follower_safe_distance_m = 32;
  for (const double gap : {32.0, 32.5, 100.0}) {
    sample.follower_gap_m = gap;
    EXPECT_EQ(metrics::CompromisedSafety(sample), 0) << gap;
  }
}

TEST(CompromisedSafetyTest, HasNoValueWithoutAFollowingCar) {
  metrics::Sample sample;
  sample.follower_gap_m = sample.follower_safe_distance_m = kNone;
  EXPECT_TRUE(std::isnan(metrics::CompromisedSafety(sample)));
}

TEST(MeasureTest, NothingIsMeasuredOfNoSamples) {
  const metrics::RunMetrics m = metrics::Measure({});
  EXPECT_EQ(m.steps, 0);
  EXPECT_EQ(m.duration_s, 0);
  EXPECT_EQ(m.min_host_gap_m, std::nullopt);
  EXPECT_EQ(m.rhe_pct, std::nullopt);
  EXPECT_EQ(m.rms_jerk_mps3, std::nullopt);
}

TEST(MeasureTest, CountsStepsAndTheTimeBetweenTheFirstAndTheLast) {
  const metrics::RunMetrics m = metrics::Measure(QuietRun(5));
  EXPECT_EQ(m.steps, 5);
  EXPECT_EQ(m.duration_s, 2.0);
}

TEST(MeasureTest, FindsTheSmallestGaps) {
  auto run = QuietRun(3);
  run[1].host_gap_m = 12;
  run[2].follower_gap_m = 7;
  const metrics::RunMetrics m = metrics::Measure(run);
  EXPECT_EQ(m.min_host_gap_m, 12);
  EXPECT_EQ(m.min_follower_gap_m, 7);
}

TEST(MeasureTest, MeasuresCompromisedSafetyEverywhereAndItsMeanInFog) {
  auto run = FoggyRun({0, 1, 3, 8});
  run[3].fog_present = false;
  const metrics::RunMetrics m = metrics::Measure(run);
  EXPECT_EQ(m.max_compromised_safety_m, 8);
  EXPECT_EQ(m.mean_compromised_safety_fog_m, 4.0 / 3);
}

TEST(MeasureTest, SlowDownIsTheDropOfTheHostsSpeedSinceTheFogBegan) {
  auto run = QuietRun(6);
  const std::array<double, 6> speed{25, 20, 21, 17, 19, 10};
  for (std::size_t k = 0; k < run.size(); ++k) run[k].host_speed_mps = speed[k];
  EXPECT_EQ(metrics::Measure(run).max_slow_down_fog_mps, std::nullopt);
  for (const std::size_t k : {1, 2, 3, 4}) run[k].fog_present = true;
  EXPECT_EQ(metrics::Measure(run).max_slow_down_fog_mps, 3);
  run[3].host_speed_mps = run[4].host_speed_mps = 22;  // the host only speeds up
  EXPECT_EQ(metrics::Measure(run).max_slow_down_fog_mps, 0);
}

// A run of 12 steps of 0.5 s with fog from step 2 to step 4. The track is wrong in the steps
// `wrong`.
std::vector<metrics::Sample> RunAroundFog(const std::vector<std::size_t>& wrong) {
  std::vector<metrics::Sample> run = QuietRun(12);
  for (const std::size_t k : {2, 3, 4}) run[k].fog_present = true;
  for (const std::size_t k : wrong) run[k].fused_distance_m = 25;
  return run;
}

void Shorten(std::vector<metrics::Sample>& run, std::size_t step, double shortfall_m) {
  run[step].follower_gap_m -= shortfall_m;
}

TEST(MeasureTest, CompromisedSafetyUntilRecoveryEndsWhenTheTrackIsRightForGood) {
  auto run = RunAroundFog({5, 7});  // track right at step 6, wrong again at 7
  Shorten(run, 1, 9);               // before the fog
  Shorten(run, 3, 1);
  Shorten(run, 6, 2);
  Shorten(run, 7, 3);
  Shorten(run, 8, 9);  // the track is right again
  const metrics::RunMetrics m = metrics::Measure(run);
  EXPECT_EQ(m.max_compromised_safety_until_recovery_m, 3);
  EXPECT_EQ(m.mean_compromised_safety_until_recovery_m, 6.0 / 6);  // steps 2 to 7
  EXPECT_EQ(m.mean_compromised_safety_fog_m, 1.0 / 3);
  EXPECT_EQ(m.max_compromised_safety_m, 9);
}

TEST(MeasureTest, CompromisedSafetyUntilRecoveryHasAtLeastTheFogAndAtMostTheRun) {
  auto run = RunAroundFog({});
  Shorten(run, 4, 2);
  Shorten(run, 5, 9);
  EXPECT_EQ(metrics::Measure(run).max_compromised_safety_until_recovery_m, 2);
  EXPECT_EQ(metrics::Measure(run).mean_compromised_safety_until_recovery_m, 2.0 / 3);
  // A track that is wrong at the end of the run has not recovered.
  run[11].fused_distance_m = 25;
  EXPECT_EQ(metrics::Measure(run).max_compromised_safety_until_recovery_m, 9);
  EXPECT_EQ(metrics::Measure(run).mean_compromised_safety_until_recovery_m, 11.0 / 10);
}

TEST(MeasureTest, WithoutFogThereIsNothingToRecoverFrom) {
  auto run = QuietRun(4);
  run[1].fused_distance_m = 25;
  Shorten(run, 2, 1);
  EXPECT_EQ(metrics::Measure(run).max_compromised_safety_until_recovery_m, std::nullopt);
  EXPECT_EQ(metrics::Measure(run).mean_compromised_safety_until_recovery_m, std::nullopt);
}

TEST(MeasureTest, WithoutAFollowingCarItsMeasuresHaveNoValue) {
  auto run = FoggyRun({0, 0});
  for (metrics::Sample& sample : run)
    sample.follower_gap_m = sample.follower_safe_distance_m = kNone;
  const metrics::RunMetrics m = metrics::Measure(run);
  EXPECT_EQ(m.min_follower_gap_m, std::nullopt);
  EXPECT_EQ(m.max_compromised_safety_m, std::nullopt);
  EXPECT_EQ(m.mean_compromised_safety_fog_m, std::nullopt);
  EXPECT_EQ(m.min_host_gap_m, 30);
}

TEST(MeasureTest, KeepsTheFirstCollision) {
  auto run = QuietRun(4);
  EXPECT_EQ(metrics::Measure(run).collision, truth_t::COLLISION_NONE);
  EXPECT_EQ(metrics::Measure(run).collision_time_s, std::nullopt);
  for (std::size_t k : {2, 3}) {
    run[k].collision = truth_t::COLLISION_FOLLOWER;
    run[k].collision_time_s = 0.75;
  }
  EXPECT_EQ(metrics::Measure(run).collision, truth_t::COLLISION_FOLLOWER);
  EXPECT_EQ(metrics::Measure(run).collision_time_s, 0.75);
}

TEST(MeasureTest, RedundantEngagementIsTheHumansShareOfClearAir) {
  auto run = QuietRun(10);
  run[4].fog_present = run[5].fog_present = true;
  for (std::size_t k : {3, 4, 5, 6}) run[k].lambda_human = 1;
  EXPECT_EQ(metrics::Measure(run).rhe_pct, 25);  // steps 3 and 6 of 8
  for (metrics::Sample& sample : run) sample.lambda_human = 1;
  EXPECT_EQ(metrics::Measure(run).rhe_pct, 100);
  for (metrics::Sample& sample : run) sample.lambda_human = 0;
  EXPECT_EQ(metrics::Measure(run).rhe_pct, 0);
  for (metrics::Sample& sample : run) sample.fog_present = true;
  EXPECT_EQ(metrics::Measure(run).rhe_pct, std::nullopt);
}

TEST(MeasureTest, CountsHandOversInBothDirectionsAndTheHumansTime) {
  auto run = QuietRun(10);
  for (std::size_t k : {2, 3, 4, 8, 9}) run[k].lambda_human = 1;
  const metrics::RunMetrics m = metrics::Measure(run);
  EXPECT_EQ(m.transfers, 3);
  EXPECT_EQ(m.human_time_s, 4 * kStep_s);  // the command of the last step has no duration
}

TEST(MeasureTest, JumpOfTheCommandCountsOnlyAtHandOvers) {
  auto run = QuietRun(6);
  run[3].lambda_human = run[4].lambda_human = 1;
  const std::array<double, 6> command{0, 5, 5, 4.5, -2, -1};
  for (std::size_t k = 0; k < run.size(); ++k) run[k].command_mps2 = command[k];
  EXPECT_EQ(metrics::Measure(run).max_handover_jump_mps2, 1);  // 0.5 at step 3, 1 at step 5
  for (metrics::Sample& sample : run) sample.lambda_human = 0;
  EXPECT_EQ(metrics::Measure(run).max_handover_jump_mps2, 0);
}

TEST(MeasureTest, CountsHandOversPerMinuteAndTheLeastTimeBetweenTwo) {
  auto run = QuietRun(13);  // 6 s
  EXPECT_EQ(metrics::Measure(run).transfers_pmin, 0);
  for (std::size_t k : {2, 3, 4, 5, 10, 11, 12}) run[k].lambda_human = 1;
  const metrics::RunMetrics m = metrics::Measure(run);
  EXPECT_EQ(m.transfers_pmin, 30);        // 3 in 6 s
  EXPECT_EQ(m.min_dwell_s, 4 * kStep_s);  // steps 2 to 6
  for (std::size_t k = 0; k < 10; ++k) run[k].lambda_human = 0;
  EXPECT_EQ(metrics::Measure(run).min_dwell_s, std::nullopt);
  EXPECT_EQ(metrics::Measure(QuietRun(1)).transfers_pmin, std::nullopt);
}

TEST(MeasureTest, JerkOfAHandOverIsWhatFollowsAChangeOfTheAuthorities) {
  Scenario scenario;
  scenario.measures.handover_s = 2 * kStep_s;
  auto run = QuietRun(10);
  const std::array<double, 10> acceleration{0, 0, 3, 3, 2, 2, 4, 4, 4, 4};
  for (std::size_t k = 0; k < run.size(); ++k) run[k].host_acceleration_mps2 = acceleration[k];
  EXPECT_EQ(metrics::Measure(run, scenario).max_handover_jerk_mps3, std::nullopt);
  // The command of step 3 takes effect at step 4. Steps 4 and 5 belong to the hand-over. The jump
  // at step 2 is before the hand-over, and the jump at step 6 is after the hand-over.
  for (std::size_t k = 3; k < run.size(); ++k) run[k].lambda_human = 1;
  EXPECT_EQ(metrics::Measure(run, scenario).max_handover_jerk_mps3, 2);
  // A ramp takes time: authority still changes at step 4, so step 6 belongs to the hand-over, too.
  run[3].lambda_human = 0.5;
  EXPECT_EQ(metrics::Measure(run, scenario).max_handover_jerk_mps3, 4);
}

TEST(MeasureTest, AStepWithoutACommandCountsLikeTheStepBefore) {
  Scenario scenario;
  scenario.step_s = kStep_s;
  scenario.health.lost_periods = 2.5;
  auto run = QuietRun(6);
  for (metrics::Sample& sample : run) {
    sample.lambda_human = 1;
    sample.lambda_automation = 0;
    sample.doc = 0.9;
    sample.threshold = 0.5;
  }
  const metrics::RunMetrics whole = metrics::Measure(run, scenario);
  for (const std::size_t k : {2, 4}) {
    run[k].lambda_human = run[k].lambda_automation = run[k].doc = run[k].threshold =
        run[k].command_mps2 = kNone;
  }
  const metrics::RunMetrics m = metrics::Measure(run, scenario);
  EXPECT_EQ(m.transfers, 0);
  EXPECT_EQ(m.rhe_pct, 100);
  EXPECT_EQ(m.human_time_s, whole.human_time_s);
  EXPECT_EQ(m.max_handover_jerk_mps3, std::nullopt);
  EXPECT_EQ(m.detection.wrong_human_s, whole.detection.wrong_human_s);
  EXPECT_EQ(m.detection.false_alarms_ph, whole.detection.false_alarms_ph);
  // A command that is too old is lost, and the vehicle stops by itself.
  auto silent = run;
  for (std::size_t k = 1; k < silent.size(); ++k) silent[k].lambda_human = kNone;
  EXPECT_EQ(metrics::Measure(silent, scenario).human_time_s, 2 * kStep_s);
  EXPECT_EQ(metrics::Measure(silent, scenario).minimal_risk_s, 3 * kStep_s);
  silent[5].lambda_human = 1;  // too late: the vehicle stays in its manoeuvre
  EXPECT_EQ(metrics::Measure(silent, scenario).minimal_risk_s, 3 * kStep_s);
  EXPECT_EQ(metrics::Measure(silent, scenario).transfers, 1);
  // Before the first command, the automation drives.
  run[0].lambda_human = run[0].lambda_automation = run[0].doc = run[0].threshold = kNone;
  EXPECT_EQ(metrics::Measure(run, scenario).human_time_s, whole.human_time_s - kStep_s);
}

TEST(MeasureTest, JerkOfAHandOverAlsoFollowsTheBeginOfAMinimalRiskManoeuvre) {
  auto run = QuietRun(6);
  for (metrics::Sample& sample : run) sample.lambda_automation = 1;
  for (std::size_t k = 3; k < run.size(); ++k) run[k].lambda_automation = 0;
  for (std::size_t k = 4; k < run.size(); ++k) run[k].host_acceleration_mps2 = -2;
  EXPECT_EQ(metrics::Measure(run).max_handover_jerk_mps3, 2 / kStep_s);
}

TEST(MeasureTest, MeasuresBothPairsOfCars) {
  auto run = QuietRun(3);
  for (metrics::Sample& sample : run) {
    sample.preceding_speed_mps = 20;
    sample.host_speed_mps = 20;
    sample.follower_speed_mps = 20;
  }
  run[1].host_speed_mps = 15;  // 5 m/s slower than the car 32 m behind it
  run[2].preceding_speed_mps = 10;
  const metrics::RunMetrics m = metrics::Measure(run);
  EXPECT_EQ(m.follower.min_ttc_s, 32.0 / 5);
  EXPECT_EQ(m.host.min_ttc_s, 3);
  EXPECT_EQ(m.host.min_time_gap_s, 1.5);
  EXPECT_EQ(m.follower.min_time_gap_s, 1.6);
  EXPECT_EQ(m.follower.tet_s, 0);
}

TEST(MeasureTest, JerkIsTheChangeOfTheAppliedAccelerationOverTime) {
  auto run = QuietRun(5);
  const std::array<double, 5> acceleration{0, 2, 2.5, 0.5, 0.5};
  for (std::size_t k = 0; k < run.size(); ++k) run[k].host_acceleration_mps2 = acceleration[k];
  const metrics::RunMetrics m = metrics::Measure(run);
  // The changes are 0.5, -2 and 0, within 0.5 s each. The 2 m/s2 of step 1 do not count as a
  // change, because step 0 has no applied acceleration.
  EXPECT_EQ(m.max_abs_jerk_mps3, 4);
  EXPECT_EQ(m.rms_jerk_mps3, std::sqrt((1.0 + 16.0 + 0.0) / 3));
  EXPECT_EQ(m.max_abs_acceleration_mps2, 2.5);
}

// A run of 10 s: a hand-over at 4 s makes the acceleration jump by 0.6 m/s2. At 8 s, after the
// hand-over, the acceleration rises by 1.5 m/s3 for 1 s.
std::vector<metrics::Sample> RunWithAJump(double step_s) {
  std::vector<metrics::Sample> run(static_cast<std::size_t>(std::lround(10 / step_s)) + 1);
  for (std::size_t k = 0; k < run.size(); ++k) {
    run[k].step = static_cast<std::int64_t>(k);
    run[k].time_s = static_cast<double>(std::llround(1e6 * step_s * static_cast<double>(k))) * 1e-6;
    const double time_s = run[k].time_s;
    run[k].lambda_human = time_s > 4 - 1e-9 ? 1 : 0;
    run[k].host_acceleration_mps2 =
        (time_s > 4 + 1e-9 ? 0.4 : -0.2) + 1.5 * std::clamp(time_s - 8, 0.0, 1.0);
  }
  return run;
}

TEST(MeasureTest, JerkOverASecondDoesNotDependOnTheStepButTheJerkOfAJumpDoes) {
  for (const double step_s : {0.1, 0.05, 0.02}) {
    const metrics::RunMetrics m = metrics::Measure(RunWithAJump(step_s));
    EXPECT_NEAR(*m.max_handover_jerk_1s_mps3, 0.6, 1e-9) << step_s;
    EXPECT_NEAR(*m.max_abs_jerk_1s_mps3, 1.5, 1e-9) << step_s;
    EXPECT_NEAR(*m.max_handover_jerk_mps3, 0.6 / step_s, 1e-6) << step_s;
    EXPECT_NEAR(*m.max_abs_jerk_mps3, 0.6 / step_s, 1e-6) << step_s;
  }
}

TEST(MeasureTest, JerkOverASecondNeedsASecondAndAHandOver) {
  EXPECT_EQ(metrics::Measure(QuietRun(3)).max_abs_jerk_1s_mps3, std::nullopt);  // covers only 0.5 s
  EXPECT_EQ(metrics::Measure(QuietRun(4)).max_abs_jerk_1s_mps3, 0);
  EXPECT_EQ(metrics::Measure(QuietRun(4)).max_handover_jerk_1s_mps3, std::nullopt);
}

TEST(MeasureTest, BrakingCountsAsAcceleration) {
  auto run = QuietRun(3);
  run[1].host_acceleration_mps2 = 1;
  run[2].host_acceleration_mps2 = -3;
  EXPECT_EQ(metrics::Measure(run).max_abs_acceleration_mps2, 3);
  EXPECT_EQ(metrics::Measure(run).max_abs_jerk_mps3, 8);
}

TEST(MeasureTest, ConflictInClearAirLeavesTheFogOut) {
  auto run = QuietRun(4);
  const std::array<double, 4> conflict{0.9, 1.4, 0.95, 0.92};
  for (std::size_t k = 0; k < run.size(); ++k) {
    run[k].conflict_m = conflict[k];
    run[k].doc = conflict[k] / 2;
  }
  run[1].fog_present = true;
  const metrics::RunMetrics m = metrics::Measure(run);
  EXPECT_EQ(m.min_conflict_clear_m, 0.9);
  EXPECT_EQ(m.max_conflict_clear_m, 0.95);
  EXPECT_EQ(m.max_doc, 0.7);
}

TEST(MeasureTest, FusionErrorCountsTheStepsWithATrack) {
  auto run = QuietRun(3);
  run[0].fused_distance_m = kNone;
  run[1].fused_distance_m = 33;
  run[2].fused_distance_m = 26;
  EXPECT_EQ(metrics::Measure(run).rms_fusion_error_m, std::sqrt((9.0 + 16.0) / 2));
}

TEST(MeasureTest, ResultMayBeAskedForAtAnyTime) {
  auto run = FoggyRun({1, 2, 3});
  metrics::MetricsAccumulator accumulator;
  for (std::size_t k = 0; k < run.size(); ++k) {
    accumulator.Add(run[k]);
    const metrics::RunMetrics so_far = accumulator.Result();
    const metrics::RunMetrics whole = metrics::Measure(std::span(run).first(k + 1));
    EXPECT_EQ(so_far.steps, whole.steps);
    EXPECT_EQ(so_far.mean_compromised_safety_fog_m, whole.mean_compromised_safety_fog_m);
  }
}

TEST(VisitMetricsTest, NamesEveryMeasureOnceWithItsUnit) {
  const std::map<std::string_view, std::string_view> suffixes{
      {"m", "_m"},       {"s", "_s"},       {"s2", "_s2"},      {"%", "_pct"}, {"m/s", "_mps"},
      {"m/s2", "_mps2"}, {"m/s3", "_mps3"}, {"1/min", "_pmin"}, {"1/h", "_ph"}};
  std::set<std::string_view> names;
  const auto check = [&](std::string_view name, auto value, std::string_view unit,
                         std::string_view description) {
    using Value = decltype(value);
    static_assert(std::is_same_v<Value, std::int64_t> ||
                  std::is_same_v<Value, std::optional<double>>);
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_FALSE(description.empty()) << name;
    if (!unit.empty()) {
      EXPECT_TRUE(name.ends_with(suffixes.at(unit))) << name << " in " << unit;
    }
  };
  metrics::VisitMetrics(metrics::RunMetrics(), check);
  EXPECT_EQ(names.size(), 50U);
}

TEST(VisitMetricsTest, SaysTheSameOfTheHostAndOfTheFollowingCar) {
  constexpr std::string_view kHost = "host: ";
  constexpr std::string_view kFollower = "following car: ";
  std::map<std::string, std::string, std::less<>> host;
  std::map<std::string, std::string, std::less<>> follower;
  const auto without = [](std::string_view name, std::string_view car) {
    const std::size_t at = name.find(car);
    return std::string(name.substr(0, at)) + std::string(name.substr(at + car.size()));
  };
  metrics::VisitMetrics(metrics::RunMetrics(), [&](std::string_view name, const auto&,
                                                   std::string_view, std::string_view description) {
    if (description.starts_with(kHost)) {
      host[without(name, "host")] = description.substr(kHost.size());
    } else if (name.find("follower") != name.npos) {
      ASSERT_TRUE(description.starts_with(kFollower)) << name << ": " << description;
      follower[without(name, "follower")] = description.substr(kFollower.size());
    }
  });
  EXPECT_EQ(host.size(), 10U);
  EXPECT_EQ(host, follower);
}

}  // namespace
}  // namespace fogline
