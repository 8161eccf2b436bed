#include "tools/trials/tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/command.h"
#include "tools/runner/experiment.h"

namespace fogline::trials {
namespace {

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
    runner::RunExperiment(scenario, {.transport = "direct", .log = log_});
  }
  /// Adds the end of the trial, and its answer.
  void Answer(double value) const {
    const TrialStory story = ReadStory(log_);
    trial_t answer{};
    answer.header.run_id = story.run_id;
    answer.participant = answer.trial = answer.attempt = 1;
    answer.kind = trial_t::ANSWER;
    answer.questionnaire = "speed";
    answer.item = "guess";
    answer.value = value;
    trial_t end = answer;
    end.kind = trial_t::END;
    end.sequence = 1;
    AddFacts(log_, story, {answer, end}, nullptr);
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

}  // namespace
}  // namespace fogline::trials
