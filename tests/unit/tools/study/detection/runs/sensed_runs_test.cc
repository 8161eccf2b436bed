#include "tools/study/detection/runs/sensed_runs.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenario/io/loader.h"
#include "services/closed_loop/closed_loop.h"
#include "tests/support/command.h"

namespace fogline {
namespace {

/// A scenario in which the human always drives, with fog of this model in the last 12 s.
Scenario Driven(const std::string& fog) {
  Scenario scenario = LoadScenario(
      test::SourceDirectory() / "scenario/paper.json",
      {"/arbitrator/policy=traded", "/arbitrator/threshold=0", "/arbitrator/missing_lidar=conflict",
       "/fog/model=" + fog, "/fog/visibility_m=60", "/fog/start_s=3", "/radar/range_std_m=0.25"});
  scenario.steps = 150;
  return scenario;
}

using Scores = std::vector<std::vector<double>>;

Scores OfTheClosedLoop(Scenario scenario, std::int64_t seed) {
  scenario.seed = seed;
  study::DetectorBank bank(study::DetectorParameters(scenario), study::AllDetectors());
  policies::Witness witness(scenario);
  Scores scores;
  closed_loop::ClosedLoop(scenario).Run(0, [&](const closed_loop::StepView& step) {
    const auto of_step =
        bank.Step({.radar = policies::StatedBy(step.radar),
                   .lidar = policies::StatedBy(step.lidar),
                   .prediction = witness.Prediction(step.track, step.radar, step.lidar)});
    scores.emplace_back(of_step.begin(), of_step.end());
  });
  return scores;
}

Scores OfTheSensors(const study::Traffic& traffic, const std::vector<std::size_t>& detectors,
                    std::int64_t seed) {
  study::SensorBench bench(traffic, detectors);
  Scores scores;
  for (const std::int64_t other : {seed + 1, seed}) {  // the first run must not change the second
    scores.clear();
    bench.Run(other, [&](const truth_t&, std::span<const double> of_step) {
      scores.emplace_back(of_step.begin(), of_step.end());
    });
  }
  return scores;
}

TEST(SensorBenchTest, GivesTheScoresOfTheClosedLoop) {
  for (const std::string fog : {"bias", "beam"}) {
    const Scenario scenario = Driven(fog);
    const study::Traffic traffic = study::TrafficOf(scenario);
    EXPECT_EQ(OfTheSensors(traffic, study::AllDetectors(), 5), OfTheClosedLoop(scenario, 5)) << fog;
  }
}

TEST(SensorBenchTest, QuickDetectorsNeedNoFilter) {
  const study::Traffic traffic = study::TrafficOf(Driven("bias"));
  const std::vector<std::size_t> quick = study::QuickDetectors();
  const Scores some = OfTheSensors(traffic, quick, 8);
  const Scores all = OfTheSensors(traffic, study::AllDetectors(), 8);
  ASSERT_EQ(some.size(), all.size());
  for (std::size_t step = 0; step < all.size(); ++step) {
    for (std::size_t i = 0; i < quick.size(); ++i) {
      EXPECT_EQ(some[step][i], all[step][quick[i]]) << study::Detectors()[quick[i]].name;
    }
  }
}

}  // namespace
}  // namespace fogline
