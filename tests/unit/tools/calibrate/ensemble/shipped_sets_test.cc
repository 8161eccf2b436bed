// Tests that the sets of parameters in scenario/ensemble can be loaded, are distinct, and meet the
// published table.
#include <cstddef>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "common/text.h"
#include "scenario/io/loader.h"
#include "tests/support/command.h"
#include "tools/calibrate/ensemble/ensemble.h"
#include "tools/calibrate/ensemble/ensemble_report.h"
#include "tools/calibrate/steady_start.h"

namespace fogline::test {
namespace {

constexpr std::size_t kSets = 8;
// The seeds with which the sets of parameters were searched, and the fresh seeds that confirmed
// these sets (scenario/ensemble/README.md).
constexpr sweep::SeedRange kSearched{1001, 1040};
constexpr sweep::SeedRange kFresh{2001, 2200};

std::filesystem::path Folder() { return SourceDirectory() / "scenario/ensemble"; }

Scenario Set(std::size_t index) { return LoadScenario(Folder() / calibrate::SetFileName(index)); }

std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

/// The free fields of sets.csv, with their bounds. For each field, `values` has the text of its
/// value in each set.
struct FreeFields {
  std::vector<calibrate::FreeField> fields;
  std::vector<std::vector<std::string>> values;
};

FreeFields ReadTable() {
  FreeFields table;
  std::istringstream lines(Content(Folder() / "sets.csv"));
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> cells = CellsOf(line);
    if (!line.starts_with('/') || cells[2].empty()) continue;
    table.fields.emplace_back(
        fmt::format("{}={}:{}{}", cells[0], cells[2], cells[3], cells[4] == "log" ? ":log" : ""));
    table.values.emplace_back(cells.begin() + 5, cells.end());
  }
  return table;
}

TEST(ShippedSetsTest, HaveTheValuesOfTheTable) {
  const FreeFields table = ReadTable();
  ASSERT_EQ(table.fields.size(), 17U);
  for (std::size_t i = 0; i < table.fields.size(); ++i) {
    ASSERT_EQ(table.values[i].size(), kSets);
    for (std::size_t set = 0; set < kSets; ++set) {
      EXPECT_EQ(NumberText(table.fields[i].Get(Set(set))), table.values[i][set])
          << table.fields[i].pointer() << " of set " << set + 1;
    }
  }
}

TEST(ShippedSetsTest, AreDistinct) {
  calibrate::CalibrationProblem problem;
  problem.fields = ReadTable().fields;
  std::vector<calibrate::ParameterSet> sets(kSets);
  for (std::size_t set = 0; set < kSets; ++set) {
    const Scenario scenario = Set(set);
    for (const calibrate::FreeField& field : problem.fields) {
      const double value = field.Get(scenario);
      EXPECT_LE(field.lowest(), value) << field.pointer();
      EXPECT_GE(field.highest(), value) << field.pointer();
      sets[set].values.push_back(value);
    }
  }
  EXPECT_GE(calibrate::LeastDistance(problem, sets), calibrate::EnsembleRules().apart);
}

TEST(ShippedSetsTest, BeginInEquilibrium) {
  for (std::size_t set = 0; set < kSets; ++set) {
    const Scenario shipped = Set(set);
    Scenario derived = shipped;
    calibrate::StartSteadily(derived);
    EXPECT_EQ(PrintScenario(derived), PrintScenario(shipped)) << set + 1;
  }
}

TEST(ShippedSetsTest, MeetThePublishedTable) {
  for (std::size_t set = 0; set < kSets; ++set) {
    for (const sweep::SeedRange& seeds : {kSearched, kFresh}) {
      calibrate::CalibrationProblem problem;
      problem.scenario = Set(set);
      problem.target = calibrate::PublishedTarget(problem.scenario);
      problem.seeds = seeds;
      problem.jobs = 2;
      ASSERT_EQ(problem.target.size(), 3U);
      const auto table = calibrate::Objective(problem).Evaluate({}, [] { return true; });
      EXPECT_LE(calibrate::TableDistance(*table), calibrate::EnsembleRules().within)
          << "set " << set + 1 << ", seeds from " << seeds.first;
    }
  }
}

TEST(ShippedSetsTest, DifferFromThePaperScenarioOnlyInTheirFields) {
  const Scenario paper = LoadScenario(SourceDirectory() / "scenario/paper.json");
  const FreeFields table = ReadTable();
  for (std::size_t set = 0; set < kSets; ++set) {
    Scenario scenario = Set(set);
    for (const calibrate::FreeField& field : table.fields) field.Set(scenario, field.Get(paper));
    scenario.world = paper.world;
    scenario.acc.standstill_m = paper.acc.standstill_m;
    scenario.title = paper.title;
    scenario.description = paper.description;
    EXPECT_EQ(PrintScenario(scenario), PrintScenario(paper)) << set + 1;
  }
}

}  // namespace
}  // namespace fogline::test
