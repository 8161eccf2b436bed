#include "tools/trials/tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/loader.h"
#include "tests/support/command.h"
#include "tools/runner/scenario_run.h"

namespace fogline::trials {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// An experiment with one trial, which has been run.
class TablesTest : public ::testing::Test {
 protected:
  TablesTest() {
    plan_.plan.conditions.resize(1);
    plan_.plan.conditions[0].name = "fog";
    plan_.plan.order = TrialOrder::kAsListed;
    plan_.plan.questionnaires.resize(1);
    plan_.plan.questionnaires[0].name = "speed";
    plan_.plan.questionnaires[0].items.resize(1);
    plan_.plan.questionnaires[0].items[0].name = "guess";
    plan_.plan.questionnaires[0].items[0].unit = "km/h, estimated";
    std::filesystem::create_directories(results_.FolderOf(1));
    log_ = results_.LogOf({}, 1);
  }

  /// Makes the run of the trial.
  void Run(const Scenario& scenario) const {
    runner::RunScenario(scenario, {.transport = "direct", .log = log_});
  }
  /// Adds the end of the trial, and its answer.
  void Answer(double value, const std::string& experiment_hash = "") const {
    const TrialStory story = ReadStory(log_);
    trial_t answer{};
    answer.header.run_id = story.run_id;
    answer.participant = answer.trial = answer.attempt = 1;
    answer.condition = "fog";
    answer.experiment_hash = experiment_hash;
    answer.kind = trial_t::ANSWER;
    answer.questionnaire = "speed";
    answer.item = "guess";
    answer.value = value;
    trial_t end = answer;
    end.kind = trial_t::END;
    end.sequence = 1;
    AddFacts(log_, story, {answer, end}, nullptr);
  }

  /// The only row of the table of trials, by the names of its columns.
  std::map<std::string, std::string> Row() const {
    std::istringstream lines(MakeTables(plan_, results_).trials);
    std::vector<std::vector<std::string>> table;
    for (std::string line; std::getline(lines, line);) {
      auto& cells = table.emplace_back();
      std::istringstream text(line + ",");
      for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    }
    std::map<std::string, std::string> row;
    if (table.size() != 2 || table[0].size() != table[1].size()) return row;
    for (std::size_t i = 0; i < table[0].size(); ++i) row[table[0][i]] = table[1][i];
    return row;
  }

  test::ScratchFolder folder_;
  PlanFile plan_{.file = "e.json", .text = "{}\n", .hash = "", .plan = {}};
  Results results_{plan_, folder_.path() / "r"};
  std::filesystem::path log_;
};

TEST_F(TablesTest, AUnitWithACommaIsOneCell) {
  Scenario scenario;
  scenario.steps = 20;
  Run(scenario);
  Answer(6);
  EXPECT_THAT(MakeTables(plan_, results_).values,
              HasSubstr("\n1,1,0,fog,answer,speed.guess,6,\"km/h, estimated\",\n"));
}

TEST_F(TablesTest, ALogOfAnotherVersionOfTheExperimentIsAFault) {
  Scenario scenario;
  scenario.steps = 20;
  Run(scenario);
  Answer(6, "of another version");
  const Tables tables = MakeTables(plan_, results_);
  EXPECT_THAT(tables.faults,
              ElementsAre(log_.string() + ": the log is of another version of the experiment"));
  EXPECT_EQ(Row().at("state"), "broken");
}

TEST_F(TablesTest, ATrialHasTheMeasuresOfItsFirstRequest) {
  Run(LoadScenario(
      test::SourceDirectory() / "scenario/dense_fog.json",
      {"/steps=120", "/fog/start_s=1", "/fog/duration_s=4", "/arbitrator/take_over/mode=requested",
       "/arbitrator/take_over/time/mean_s=2", "/arbitrator/take_over/time/std_s=0.01"}));
  Answer(6);
  const runner::LoggedRun run = runner::ReadLoggedRun(log_);
  ASSERT_FALSE(run.result.take_overs.empty());
  const metrics::TakeOverMeasures& first = run.result.take_overs[0];
  ASSERT_TRUE(first.take_over_time_s);
  const std::map<std::string, std::string> row = Row();
  ASSERT_TRUE(row.contains("requests"));
  EXPECT_EQ(row.at("requests"), std::to_string(run.result.take_overs.size()));
  EXPECT_EQ(row.at("first_request_outcome"), "taken_over");
  metrics::VisitTakeOver(first, [&](const std::string_view name, const std::optional<double>& value,
                                    std::string_view, std::string_view) {
    const auto cell = row.find(fmt::format("first_request_{}", name));
    ASSERT_NE(cell, row.end()) << name;
    EXPECT_EQ(cell->second, value ? NumberText(*value) : "") << name;
  });
  EXPECT_EQ(row.at("input_latency_p95_us"), "") << "no person drove";
  EXPECT_THAT(MakeTables(plan_, results_).values,
              HasSubstr(fmt::format("\n1,1,0,fog,metric,first_request_take_over_time_s,{},s,\n",
                                    NumberText(*first.take_over_time_s))));
}

TEST_F(TablesTest, TheDocumentationNamesTheMeasuresOfARequest) {
  const std::string docs = test::Content(test::SourceDirectory() / "docs/experiment.md");
  metrics::VisitTakeOver(
      {}, [&](std::string_view name, const std::optional<double>&, std::string_view,
              std::string_view) { EXPECT_THAT(docs, HasSubstr(fmt::format("`{}`", name))); });
}

TEST_F(TablesTest, ARunWithoutARequestHasNoMeasuresOfOne) {
  Scenario scenario;
  scenario.steps = 20;
  Run(scenario);
  Answer(6);
  const std::map<std::string, std::string> row = Row();
  ASSERT_TRUE(row.contains("requests"));
  EXPECT_EQ(row.at("requests"), "0");
  EXPECT_EQ(row.at("first_request_outcome"), "");
  EXPECT_EQ(row.at("first_request_speed_at_request_mps"), "");
  EXPECT_NE(row.at("duration_s"), "");
}

TEST_F(TablesTest, ARunThatBrokeOffHasNoMeasures) {
  Scenario scenario;
  scenario.steps = 20;
  Run(scenario);
  std::filesystem::resize_file(log_, std::filesystem::file_size(log_) / 2);
  const std::map<std::string, std::string> row = Row();
  ASSERT_TRUE(row.contains("requests"));
  for (const char* name : {"duration_s", "requests", "first_request_outcome"}) {
    EXPECT_EQ(row.at(name), "") << name;
  }
}

TEST(IsTrialTableTest, IsTrueForATableOfTrialsAlone) {
  const test::ScratchFolder folder;
  const auto is_table = [&folder](std::string_view content) {
    const std::filesystem::path file = folder.File("table.csv");
    std::ofstream(file) << content;
    return IsTrialTable(file);
  };
  EXPECT_TRUE(is_table("participant,trial,practice,condition,replaced\n"));
  EXPECT_FALSE(is_table("time_s,gap_m\n"));
  EXPECT_FALSE(is_table("\nthe notes of the experimenter\n"));
  EXPECT_FALSE(is_table(""));
}

}  // namespace
}  // namespace fogline::trials
