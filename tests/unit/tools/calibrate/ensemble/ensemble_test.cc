#include "tools/calibrate/ensemble/ensemble.h"

#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenario/io/loader.h"
#include "tests/support/input_errors.h"
#include "tools/calibrate/ensemble/ensemble_files.h"
#include "tools/calibrate/ensemble/ensemble_report.h"

namespace fogline {
namespace {

using ::testing::HasSubstr;

bool Always() { return true; }

constexpr const char* kText = R"({
  "$schema": "scenario.schema.json",
  "version": 1,
  "title": "Short",
  "steps": 120,
  "fog": { "model": "bias", "profile": "half_sine", "start_s": 2, "duration_s": 8, "bias_m": 0.4 },
  "radar": { "bias_m": 0.95, "range_std_m": 0.01 },
  "lidar": { "range_std_m": 0.01 }
})";

// The target is the table that the scenario gives with a fog bias of 0.4 m and a radar bias of
// 0.95 m. So at least these values meet the target. Other values meet it, too, because a change of
// one bias can compensate a change of the other bias.
calibrate::CalibrationProblem ShortProblem() {
  calibrate::CalibrationProblem problem;
  problem.scenario = ParseScenario(kText);
  problem.fields = calibrate::ParseFreeFields({"/fog/bias_m=0.2:0.6", "/radar/bias_m=0.92:0.97"});
  problem.target = {{.threshold = 0.8, .si_pct = {}, .rhe_pct = {}}};
  problem.seeds = {1, 4};
  const auto here = *calibrate::Objective(problem).Evaluate(std::vector{0.4, 0.95}, Always);
  problem.target[0].si_pct = here.rows[0].si_pct.mean();
  return problem;
}

struct Search {
  calibrate::Objective searched;
  calibrate::Objective fresh;
  calibrate::EnsembleRules rules{
      .sets = 3, .within = 8, .apart = 0.15, .starts = 25, .evaluations = 40};

  explicit Search(const calibrate::CalibrationProblem& problem)
      : searched(problem), fresh(calibrate::WithFreshSeeds(problem, {101, 106})) {}

  calibrate::ParameterEnsemble Find(const calibrate::GoOn& go_on = Always) const {
    return calibrate::FindEnsemble(searched, fresh, rules, go_on,
                                   [](int, const calibrate::EnsembleCounts&) {});
  }
};

std::vector<std::vector<double>> ValuesOf(const calibrate::ParameterEnsemble& ensemble) {
  std::vector<std::vector<double>> values;
  for (const auto& set : ensemble.sets) values.push_back(set.values);
  return values;
}

TEST(EnsembleTest, HasDistinctSetsThatMeetTheTargetOverBothKindsOfSeeds) {
  const Search search(ShortProblem());
  const calibrate::ParameterEnsemble found = search.Find();
  ASSERT_EQ(found.sets.size(), 3U);
  for (const auto& set : found.sets) {
    EXPECT_LE(calibrate::TableDistance(set.searched), search.rules.within);
    EXPECT_LE(calibrate::TableDistance(set.fresh), search.rules.within);
    EXPECT_EQ(set.searched.objective, search.searched.Evaluate(set.values, Always)->objective);
    EXPECT_EQ(set.fresh.objective, search.fresh.Evaluate(set.values, Always)->objective);
    EXPECT_EQ(set.searched.rows[0].si_pct.count(), 4);
    EXPECT_EQ(set.fresh.rows[0].si_pct.count(), 6);
  }
  EXPECT_GE(calibrate::LeastDistance(search.searched.problem(), found.sets), search.rules.apart);
}

TEST(EnsembleTest, IsTheSameForASeedOnAnyNumberOfThreads) {
  calibrate::CalibrationProblem problem = ShortProblem();
  const calibrate::ParameterEnsemble one = Search(problem).Find();
  problem.jobs = 3;
  const calibrate::ParameterEnsemble three = Search(problem).Find();
  EXPECT_EQ(ValuesOf(three), ValuesOf(one));
  EXPECT_EQ(three.counts.evaluations, one.counts.evaluations);
  Search other(problem);
  other.rules.seed = 2;
  EXPECT_NE(ValuesOf(other.Find()), ValuesOf(one));
}

TEST(EnsembleTest, ConfirmsNoSetOnSeedsOfTheSearch) {
  for (const sweep::SeedRange fresh : {sweep::SeedRange{4, 9}, {0, 1}, {2, 3}, {0, 9}}) {
    EXPECT_THAT(test::ErrorOf([&] { calibrate::WithFreshSeeds(ShortProblem(), fresh); }),
                HasSubstr("overlaps --seeds 1:4"));
  }
  EXPECT_EQ(calibrate::WithFreshSeeds(ShortProblem(), {5, 9}).seeds.first, 5);
}

TEST(EnsembleTest, TellsWhyTheScenarioCanRunNowhere) {
  calibrate::CalibrationProblem problem = ShortProblem();
  problem.steady = true;
  problem.scenario.world.follower_speed_mps = 25;
  EXPECT_THAT(test::ErrorOf([&] { Search(problem).Find(); }),
              HasSubstr("error: --steady: the cars differ in speed at step 0"));
}

TEST(EnsembleTest, StopsWhenAsked) {
  const calibrate::ParameterEnsemble found = Search(ShortProblem()).Find([] { return false; });
  EXPECT_TRUE(found.interrupted);
  EXPECT_TRUE(found.sets.empty());
}

TEST(EnsembleReportTest, WritesASetAsTheScenarioWithItsValuesAndItsOrigin) {
  const Search search(ShortProblem());
  const calibrate::EnsembleReport report{.searched = search.searched,
                                         .fresh = search.fresh,
                                         .rules = search.rules,
                                         .found = search.Find(),
                                         .scenario = "short.json",
                                         .command = "fogline calibrate short.json --ensemble 3"};
  ASSERT_EQ(report.found.sets.size(), 3U);
  const Scenario set = ParseScenario(calibrate::SetText(report, 1, kText));
  EXPECT_EQ(set.fog.bias_m, report.found.sets[1].values[0]);
  EXPECT_EQ(set.radar.bias_m, report.found.sets[1].values[1]);
  EXPECT_EQ(set.steps, 120);
  EXPECT_EQ(set.title, "Short, set 2");
  EXPECT_THAT(set.description, HasSubstr("within 8 points of the target, over seeds 1:4 and over "
                                         "seeds 101:106"));
  EXPECT_THAT(set.description, HasSubstr("Made by: fogline calibrate short.json --ensemble 3"));
  // AND the table and the JSON have the same values
  const auto json = nlohmann::json::parse(calibrate::EnsembleJson(report));
  EXPECT_EQ(json["sets"].size(), 3U);
  EXPECT_EQ(json["sets"][1]["file"], "set-2.json");
  EXPECT_EQ(json["sets"][1]["values"]["/fog/bias_m"], set.fog.bias_m);
  EXPECT_THAT(calibrate::EnsembleCsv(report),
              HasSubstr("\n/fog/bias_m,m,0.2,0.6,linear," +
                        json["sets"][0]["values"]["/fog/bias_m"].dump() + ","));
  EXPECT_THAT(calibrate::EnsembleText(report), HasSubstr("3 of 3 sets, within 8 points"));
}

TEST(EnsembleReportTest, WritesTheGapsThatAreDerived) {
  calibrate::CalibrationProblem problem = ShortProblem();
  problem.steady = true;
  const calibrate::Objective objective(problem);
  const std::vector<double> values{0.4, 0.95};
  const auto changes = objective.Changes(values);
  ASSERT_EQ(changes.size(), 5U);
  EXPECT_EQ(changes[2].pointer, "/world/host_gap_m");
  EXPECT_EQ(changes[2].value, objective.With(values).world.host_gap_m);
  problem.fields = calibrate::ParseFreeFields({"/acc/standstill_m=1:5"});
  EXPECT_EQ(test::ErrorOf([&] { const calibrate::Objective again(problem); }),
            "error: --free /acc/standstill_m: --steady derives it");
}

TEST(EnsembleFilesTest, LeadToTheSameSchemaFromAnotherFolder) {
  const std::string text = R"({ "$schema": "scenario.schema.json", "version": 1 })";
  EXPECT_EQ(calibrate::WithSchemaIn("/a/sets", "/a", text),
            R"({ "$schema": "../scenario.schema.json", "version": 1 })");
  EXPECT_EQ(calibrate::WithSchemaIn("/a", "/a", text), text);
  for (const char* other : {R"({ "$schema": "https://example.org/s.json", "version": 1 })",
                            R"({ "$schema": "/a/s.json", "version": 1 })", R"({ "version": 1 })"}) {
    EXPECT_EQ(calibrate::WithSchemaIn("/b", "/a", other), other);
  }
}

}  // namespace
}  // namespace fogline
