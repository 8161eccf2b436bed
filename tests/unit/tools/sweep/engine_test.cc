#include "tools/sweep/engine.h"

#include <cstdint>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/errors.h"
#include "scenario/io/loader.h"

namespace fogline {
namespace {

sweep::SweepPlan ShortPlan() {
  Scenario scenario;
  scenario.steps = 20;
  return {scenario, {sweep::ParseAxis("/arbitrator/threshold=0.2,0.8")}, {.first = 1, .last = 50}};
}

TEST(SweepEngineTest, HandsUnitsOnInOrderWithWhatAWorkerAloneComputes) {
  const sweep::SweepPlan plan = ShortPlan();
  sweep::SweepWorker worker(plan);
  std::vector<sweep::SweepRow> expected;
  std::int64_t next = 7;
  sweep::RunSweep(plan, 7, 41, 3, [&](std::int64_t unit, const std::vector<sweep::SweepRow>& rows) {
    EXPECT_EQ(unit, next++);
    worker.Compute(unit, expected);
    EXPECT_EQ(rows.size(), 2U);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_EQ(rows[i].measures.min_follower_gap_m, expected[i].measures.min_follower_gap_m);
      EXPECT_EQ(rows[i].paired.si_pct, expected[i].paired.si_pct);
      EXPECT_EQ(rows[i].paired.si_until_recovery_pct, expected[i].paired.si_until_recovery_pct);
    }
    return true;
  });
  EXPECT_EQ(next, 41);
}

/// Expects that both rows have the same values.
void ExpectSame(const sweep::SweepRow& row, const sweep::SweepRow& expected) {
  metrics::VisitMetrics(row.measures, [&](std::string_view name, const auto& value, auto, auto) {
    metrics::VisitMetrics(expected.measures, [&]<class V>(std::string_view other, const V& wanted,
                                                          std::string_view, std::string_view) {
      if constexpr (std::is_same_v<V, std::decay_t<decltype(value)>>) {
        if (other == name) {
          EXPECT_EQ(value, wanted) << name;
        }
      }
    });
  });
  EXPECT_EQ(row.paired.si_pct, expected.paired.si_pct);
  EXPECT_EQ(row.paired.si_until_recovery_pct, expected.paired.si_until_recovery_pct);
  EXPECT_EQ(row.paired.other_si_pct, expected.paired.other_si_pct);
  EXPECT_EQ(row.without.mean_compromised_safety_m, expected.without.mean_compromised_safety_m);
  EXPECT_EQ(row.without.slow_down_mps, expected.without.slow_down_mps);
}

/// A sweep of the paper's experiment over one axis. The runs end 1 s after the fog.
sweep::SweepPlan PaperPlan(const std::string& axis, std::int64_t seeds) {
  const Scenario scenario = LoadScenario(FOGLINE_SOURCE_DIR "/scenario/paper.json", {"/steps=310"});
  return {scenario, {sweep::ParseAxis(axis)}, {.first = 1, .last = seeds}};
}

TEST(SweepEngineTest, RowsOfManyThresholdsAreThoseOfOneThresholdEach) {
  // GIVEN more thresholds than are computed at once, so the last ones have a group of their own
  const sweep::SweepPlan plan = PaperPlan("/arbitrator/threshold=0.025:1:40", 2);
  sweep::SweepWorker worker(plan);
  std::vector<sweep::SweepRow> rows;
  std::vector<sweep::SweepRow> alone;
  std::set<std::optional<double>> improvements;
  for (const std::int64_t unit : {0, 1}) {
    worker.Compute(unit, rows);
    ASSERT_EQ(rows.size(), 40U);
    for (std::int64_t row = 0; row < 40; ++row) {
      const std::string threshold(plan.ValuesOf(unit, row).front());
      const sweep::SweepPlan single = PaperPlan("/arbitrator/threshold=" + threshold, 2);
      sweep::SweepWorker(single).Compute(unit, alone);
      ASSERT_EQ(alone.size(), 1U);
      ExpectSame(rows[static_cast<std::size_t>(row)], alone.front());
      improvements.insert(alone.front().paired.si_pct);
    }
  }
  EXPECT_GT(improvements.size(), 40U) << "the rows differ, so equality says something";
}

TEST(SweepEngineTest, ARunWithoutTradedControlHasNoPairWhereverItsRowIs) {
  std::vector<sweep::SweepRow> rows;
  std::vector<sweep::SweepRow> alone;
  for (const char* policies : {"none", "none,traded", "traded,none,blend"}) {
    const sweep::SweepPlan plan = PaperPlan(std::string("/arbitrator/policy=") + policies, 1);
    sweep::SweepWorker(plan).Compute(0, rows);
    for (std::int64_t row = 0; row < plan.rows_per_unit(); ++row) {
      const std::string policy(plan.ValuesOf(0, row).front());
      const sweep::SweepRow& one = rows[static_cast<std::size_t>(row)];
      EXPECT_EQ(one.paired.si_pct.has_value(), policy != "none") << policies << row;
      EXPECT_EQ(one.without.slow_down_mps.has_value(), policy != "none") << policies << row;
      sweep::SweepWorker(PaperPlan("/arbitrator/policy=" + policy, 1)).Compute(0, alone);
      ExpectSame(one, alone.front());
    }
  }
}

TEST(SweepEngineTest, NamesTheFirstRowThatCannotBeComputed) {
  // GIVEN rows of which the arbitrator refuses all but the first one
  Scenario scenario;
  scenario.steps = 20;
  const sweep::SweepPlan plan(scenario,
                              {sweep::ParseAxis("/arbitrator/policy=isolate,traded"),
                               sweep::ParseAxis("/arbitrator/measure_scale=logistic,probability")},
                              {.first = 3, .last = 3});
  sweep::SweepWorker worker(plan);
  std::vector<sweep::SweepRow> rows;
  try {
    worker.Compute(0, rows);
    ADD_FAILURE() << "the arbitrator refuses a measure that is no probability";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/arbitrator/measure_scale: \"probability\""));
    EXPECT_THAT(error.what(),
                ::testing::EndsWith("(at /arbitrator/policy=isolate, "
                                    "/arbitrator/measure_scale=probability, seed 3)"));
  }
}

TEST(SweepEngineTest, StopsWhenItsConsumerHasEnough) {
  const sweep::SweepPlan plan = ShortPlan();
  std::int64_t consumed = 0;
  sweep::RunSweep(plan, 0, plan.units(), 2, [&](std::int64_t, const std::vector<sweep::SweepRow>&) {
    return ++consumed < 5;
  });
  EXPECT_EQ(consumed, 5);
}

TEST(SweepEngineTest, LetsAnExceptionOfItsConsumerOut) {
  const sweep::SweepPlan plan = ShortPlan();
  std::int64_t consumed = 0;
  EXPECT_THROW(sweep::RunSweep(plan, 0, plan.units(), 2,
                               [&](std::int64_t, const std::vector<sweep::SweepRow>&) -> bool {
                                 if (++consumed == 5) throw std::runtime_error("the disk is full");
                                 return true;
                               }),
               std::runtime_error);
  EXPECT_EQ(consumed, 5);
}

TEST(SweepEngineTest, HasNothingToDoForAnEmptyRange) {
  const sweep::SweepPlan plan = ShortPlan();
  sweep::RunSweep(plan, 3, 3, 2, [](std::int64_t, const std::vector<sweep::SweepRow>&) {
    ADD_FAILURE();
    return true;
  });
}

}  // namespace
}  // namespace fogline
