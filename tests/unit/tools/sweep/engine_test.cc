#include "tools/sweep/engine.h"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

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
