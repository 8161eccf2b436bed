#include "tools/study/ensemble/parameter_sets.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "tests/support/command.h"
#include "tests/support/input_errors.h"
#include "tools/calibrate/steady_start.h"

namespace fogline::test {
namespace {

std::filesystem::path Scenarios() { return SourceDirectory() / "scenario"; }

TEST(ParameterSetsTest, MakePaperJsonTheScenarioOfTheSet) {
  const std::vector<study::EnsembleSet> sets = study::ReadEnsembleSets(Scenarios());
  ASSERT_EQ(sets.size(), 8U);
  for (std::size_t i = 0; i < sets.size(); ++i) {
    EXPECT_EQ(sets[i].name, fmt::format("set {}", i + 1));
    const std::filesystem::path paper = Scenarios() / "paper.json";
    Scenario scenario = LoadScenario(paper, study::OverridesOf(sets[i], paper));
    const Scenario shipped = LoadScenario(Scenarios() / fmt::format("ensemble/set-{}.json", i + 1));
    scenario.title = shipped.title;
    scenario.description = shipped.description;
    EXPECT_EQ(PrintScenario(scenario), PrintScenario(shipped)) << sets[i].name;
  }
}

TEST(ParameterSetsTest, LeaveTheFogAndTheSensorsOfAnotherScenarioAsTheyAre) {
  const std::filesystem::path dense = Scenarios() / "dense_fog.json";
  const Scenario plain = LoadScenario(dense);
  for (const study::EnsembleSet& set : study::ReadEnsembleSets(Scenarios())) {
    const Scenario scenario = LoadScenario(dense, study::OverridesOf(set, dense));
    const Scenario paper = LoadScenario(Scenarios() / "paper.json",
                                        study::OverridesOf(set, Scenarios() / "paper.json"));
    EXPECT_EQ(scenario.radar.bias_m, 0);
    EXPECT_EQ(scenario.radar.range_std_m, plain.radar.range_std_m);
    EXPECT_EQ(scenario.lidar.range_std_m, plain.lidar.range_std_m);
    EXPECT_EQ(scenario.fusion.lidar_range_std_m, plain.fusion.lidar_range_std_m);
    EXPECT_EQ(scenario.fog.visibility_m, plain.fog.visibility_m);
    EXPECT_EQ(scenario.arbitrator.window_steps, paper.arbitrator.window_steps);
    EXPECT_EQ(scenario.acc.weight_distance, paper.acc.weight_distance);
    EXPECT_EQ(scenario.driver.headway_s, paper.driver.headway_s);
    EXPECT_EQ(scenario.measures.safety_floor_m, paper.measures.safety_floor_m);
  }
}

TEST(ParameterSetsTest, BeginInEquilibriumInDenseFog) {
  const std::filesystem::path dense = Scenarios() / "dense_fog.json";
  for (const study::EnsembleSet& set : study::ReadEnsembleSets(Scenarios())) {
    const Scenario scenario = LoadScenario(dense, study::OverridesOf(set, dense));
    Scenario steady = scenario;
    // The standstill gap of set 7 would be 4 mm below 0, so its headway is made a little shorter.
    if (set.name == "set 7") steady.acc.headway_s -= 0.0005;
    calibrate::StartSteadily(steady);
    EXPECT_NEAR(scenario.world.host_gap_m, steady.world.host_gap_m, 1.1e-4) << set.name;
    EXPECT_NEAR(scenario.world.follower_gap_m, steady.world.follower_gap_m, 1.1e-4) << set.name;
    EXPECT_NEAR(scenario.acc.standstill_m, steady.acc.standstill_m, 0.007) << set.name;
  }
}

TEST(ParameterSetsTest, AFileWithoutSetsIsRefused) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.File("ensemble"));
  const auto error = [&] { return ErrorOf([&] { study::ReadEnsembleSets(folder.path()); }); };
  EXPECT_EQ(error(), folder.File("ensemble/sets.csv") + ": error: there is no parameter set");
  std::ofstream(folder.File("ensemble/sets.csv"))
      << "quantity,unit,lowest,highest,scale_or_seeds,set-1,set-2\n"
         "/fog/bias_m,m,0.15,0.3,linear,0.2\n";
  EXPECT_EQ(error(),
            folder.File("ensemble/sets.csv") + ": error: a set has no value of /fog/bias_m");
}

}  // namespace
}  // namespace fogline::test
