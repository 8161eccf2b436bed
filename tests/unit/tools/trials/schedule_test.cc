#include "tools/trials/schedule.h"

#include <gmock/gmock-more-matchers.h>
#include <gtest/gtest.h>

#include <set>

namespace fogline::trials {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

ConditionSection Condition(const std::string& name) {
  ConditionSection condition;
  condition.name = name;
  return condition;
}

QuestionnaireSection Questionnaire(const std::string& name, QuestionnaireKind kind) {
  QuestionnaireSection questionnaire;
  questionnaire.name = name;
  questionnaire.kind = kind;
  return questionnaire;
}

ExperimentPlan SixPeople() {
  ExperimentPlan plan;
  plan.participants = 6;
  plan.conditions = {Condition("a"), Condition("b"), Condition("c")};
  plan.practice = {Condition("p")};
  return plan;
}

TEST(ScheduleTest, PracticeComesFirstAndThenTheOrderOfTheDesign) {
  const ExperimentPlan plan = SixPeople();
  const auto schedule = ScheduleOf(plan, 2);
  ASSERT_THAT(schedule, SizeIs(4));
  EXPECT_TRUE(schedule[0].practice);
  EXPECT_EQ(schedule[1].number, 1);
  EXPECT_EQ(OrderText(plan, 2), "b c a");
  EXPECT_EQ(ConditionOf(plan, schedule[3]).name, "a");
}

TEST(ScheduleTest, AllParticipantsOfABlockHaveDifferentOrdersAndThenTheyRepeat) {
  const ExperimentPlan plan = SixPeople();
  std::set<std::string> orders;
  for (int participant = 1; participant <= 6; ++participant) {
    orders.insert(OrderText(plan, participant));
  }
  EXPECT_EQ(orders.size(), 6U);
  EXPECT_EQ(OrderText(plan, 7), OrderText(plan, 1));
}

TEST(ScheduleTest, AsListedKeepsTheOrderOfTheFile) {
  ExperimentPlan plan = SixPeople();
  plan.order = TrialOrder::kAsListed;
  EXPECT_EQ(OrderText(plan, 5), "a b c");
}

TEST(ScheduleTest, SeedsOfTrialsAreDifferentForAllTrials) {
  ExperimentPlan plan = SixPeople();
  EXPECT_EQ(ScheduleOf(plan, 1)[1].seed, -1);
  plan.seeds = TrialSeeds::kTrial;
  plan.first_seed = 100;
  std::set<std::int64_t> seeds;
  for (int participant = 1; participant <= 6; ++participant) {
    for (const Trial& trial : ScheduleOf(plan, participant)) {
      if (!trial.practice) seeds.insert(trial.seed);
    }
  }
  EXPECT_EQ(seeds.size(), 18U);
  EXPECT_EQ(*seeds.begin(), 100);
  EXPECT_EQ(*seeds.rbegin(), 117);
}

TEST(ScheduleTest, QuestionsAreDueAfterEachTrialOrTheLastOne) {
  ExperimentPlan plan = SixPeople();
  plan.questionnaires = {Questionnaire("sleep", QuestionnaireKind::kKss),
                         Questionnaire("end", QuestionnaireKind::kOwn)};
  plan.questionnaires[0].practice = true;
  plan.questionnaires[1].after = AskedAfter::kLastTrial;
  const auto schedule = ScheduleOf(plan, 1);
  EXPECT_THAT(QuestionsAfter(plan, schedule[0]), SizeIs(1));
  EXPECT_THAT(QuestionsAfter(plan, schedule[1]), SizeIs(1));
  EXPECT_THAT(QuestionsAfter(plan, schedule[3]), SizeIs(2));
  EXPECT_THAT(QuestionsAfter(plan, schedule[1])[0].items, SizeIs(1));
}

TEST(ScheduleTest, ABreakIsAfterItsTrialOnly) {
  ExperimentPlan plan = SixPeople();
  plan.breaks.resize(1);
  plan.breaks[0].after_trial = 2;
  plan.breaks[0].at_least_s = 90;
  const auto schedule = ScheduleOf(plan, 1);
  EXPECT_EQ(BreakAfter(plan, schedule[0]), 0);
  EXPECT_EQ(BreakAfter(plan, schedule[1]), 0);
  EXPECT_EQ(BreakAfter(plan, schedule[2]), 90);
}

TEST(ScheduleTest, RemarksThatFourParticipantsCannotBalanceThreeConditions) {
  ExperimentPlan plan = SixPeople();
  EXPECT_THAT(BalanceRemark(plan), IsEmpty());
  plan.participants = 4;
  EXPECT_EQ(BalanceRemark(plan),
            "4 participants are not a multiple of 6, so the orders are not balanced");
}

}  // namespace
}  // namespace fogline::trials
