#include "tools/sweep/plan.h"

#include <algorithm>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"

namespace fogline {
namespace {

using ::testing::ElementsAre;

sweep::SweepPlan MakePlan() {
  return {
      Scenario(),
      {sweep::ParseAxis("/arbitrator/threshold=0.2,0.5"),
       sweep::ParseAxis("/fog/bias_m=0.1,0.2,0.3"),
       sweep::ParseAxis("/arbitrator/window_steps=4,8"), sweep::ParseAxis("/fog/model=bias,beam")},
      {.first = 3, .last = 7}};
}

TEST(SweepPlanTest, HasEveryCombinationOnce) {
  const sweep::SweepPlan plan = MakePlan();
  EXPECT_EQ(plan.units(), 3 * 2 * 5);
  EXPECT_EQ(plan.rows_per_unit(), 2 * 2);
  std::set<std::string> names;
  for (std::int64_t unit = 0; unit < plan.units(); ++unit) {
    for (std::int64_t row = 0; row < plan.rows_per_unit(); ++row) {
      names.insert(plan.NameOf(unit, row));
    }
  }
  EXPECT_EQ(static_cast<std::int64_t>(names.size()), plan.rows());
}

TEST(SweepPlanTest, ConfiguresARowWhateverTheScenarioWasBefore) {
  const sweep::SweepPlan plan = MakePlan();
  // GIVEN a scenario that has the values of the last row
  Scenario scenario = plan.base();
  plan.Configure(plan.units() - 1, plan.rows_per_unit() - 1, scenario);
  // WHEN the scenario becomes row 1 of unit 11
  plan.Configure(11, 1, scenario);
  // THEN the fields in the row's name have the values of the name, and all other fields have the
  // values of the base
  EXPECT_EQ(plan.NameOf(11, 1),
            "/arbitrator/threshold=0.2, /fog/bias_m=0.2, /arbitrator/window_steps=8, "
            "/fog/model=bias, seed 4");
  Scenario expected = plan.base();
  expected.seed = 4;
  expected.arbitrator.threshold = 0.2;
  expected.arbitrator.window_steps = 8;
  expected.fog.bias_m = 0.2;
  expected.fog.model = FogModel::kBias;
  EXPECT_EQ(PrintScenario(scenario), PrintScenario(expected));
  EXPECT_THAT(plan.ValuesOf(11, 1), ElementsAre("0.2", "0.2", "8", "bias"));
}

TEST(SweepPlanTest, RowsOfAUnitDifferInTheArbitratorAlone) {
  const sweep::SweepPlan plan = MakePlan();
  Scenario scenario = plan.base();
  for (std::int64_t unit = 0; unit < plan.units(); ++unit) {
    std::set<std::string> rest;
    for (std::int64_t row = 0; row < plan.rows_per_unit(); ++row) {
      plan.Configure(unit, row, scenario);
      Scenario without = scenario;
      without.arbitrator = {};
      rest.insert(PrintScenario(without));
    }
    EXPECT_EQ(rest.size(), 1U) << "unit " << unit;
  }
}

TEST(SweepPlanTest, ItsShardsAreAPartitionIntoPartsThatDifferByOneAtMost) {
  const sweep::SweepPlan plan = MakePlan();
  for (std::int64_t count = 1; count <= 2 * plan.units(); ++count) {
    std::int64_t next = 0;
    std::int64_t least = plan.units();
    std::int64_t most = 0;
    for (std::int64_t index = 1; index <= count; ++index) {
      const sweep::Shard shard{.index = index, .count = count};
      EXPECT_EQ(plan.ShardBegin(shard), next);
      next = plan.ShardEnd(shard);
      least = std::min(least, next - plan.ShardBegin(shard));
      most = std::max(most, next - plan.ShardBegin(shard));
    }
    EXPECT_EQ(next, plan.units()) << count << " shards";
    EXPECT_LE(most - least, 1) << count << " shards";
  }
}

TEST(SweepPlanTest, SplitsTheLargestSweepIntoTheMostShards) {
  // ShardEnd() multiplies 10^11 units by a million. The product, 10^17, must not overflow.
  const sweep::SweepPlan plan(Scenario(), {}, {.first = 1, .last = 100'000'000'000});
  const sweep::Shard last = sweep::ParseShard("1000000/1000000");
  EXPECT_EQ(plan.ShardBegin(last), 99'999'900'000);
  EXPECT_EQ(plan.ShardEnd(last), plan.units());
}

}  // namespace
}  // namespace fogline
