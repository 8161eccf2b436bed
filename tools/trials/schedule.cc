#include "tools/trials/schedule.h"

#include <algorithm>

#include <fmt/core.h>

#include "tools/trials/questionnaires.h"
#include "tools/trials/williams.h"

namespace fogline::trials {

const ConditionSection& ConditionOf(const ExperimentPlan& plan, const Trial& trial) {
  return (trial.practice ? plan.practice : plan.conditions)[trial.index];
}

std::vector<Trial> ScheduleOf(const ExperimentPlan& plan, std::int64_t participant) {
  std::vector<Trial> trials;
  for (std::size_t i = 0; i < plan.practice.size(); ++i) {
    trials.push_back({.participant = participant,
                      .practice = true,
                      .number = static_cast<std::int64_t>(i) + 1,
                      .index = i});
  }
  const std::size_t count = plan.conditions.size();
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = i;
  if (plan.order == TrialOrder::kWilliams) {
    const auto orders = WilliamsDesign(count);
    order = orders[static_cast<std::size_t>(participant - 1) % orders.size()];
  }
  for (std::size_t place = 0; place < count; ++place) {
    Trial trial{.participant = participant,
                .practice = false,
                .number = static_cast<std::int64_t>(place) + 1,
                .index = order[place]};
    if (plan.seeds == TrialSeeds::kTrial) {
      trial.seed = plan.first_seed + (participant - 1) * static_cast<std::int64_t>(count) +
                   static_cast<std::int64_t>(place);
    }
    trials.push_back(trial);
  }
  return trials;
}

std::vector<QuestionnaireSection> QuestionsAfter(const ExperimentPlan& plan, const Trial& trial) {
  const bool is_last =
      !trial.practice && trial.number == static_cast<std::int64_t>(plan.conditions.size());
  std::vector<QuestionnaireSection> questions;
  for (const QuestionnaireSection& questionnaire : plan.questionnaires) {
    const bool is_due = trial.practice ? questionnaire.practice
                                       : is_last || questionnaire.after == AskedAfter::kEachTrial;
    if (is_due) questions.push_back(WithItems(questionnaire));
  }
  return questions;
}

double BreakAfter(const ExperimentPlan& plan, const Trial& trial) {
  double longest_s = 0;
  for (const BreakSection& pause : plan.breaks) {
    if (!trial.practice && pause.after_trial == trial.number) {
      longest_s = std::max(longest_s, pause.at_least_s);
    }
  }
  return longest_s;
}

std::string OrderText(const ExperimentPlan& plan, std::int64_t participant) {
  std::string text;
  for (const Trial& trial : ScheduleOf(plan, participant)) {
    if (trial.practice) continue;
    text += (text.empty() ? "" : " ") + ConditionOf(plan, trial).name;
  }
  return text;
}

std::string BalanceRemark(const ExperimentPlan& plan) {
  if (plan.order != TrialOrder::kWilliams) return "";
  const auto block = static_cast<std::int64_t>(WilliamsDesign(plan.conditions.size()).size());
  if (plan.participants % block == 0) return "";
  return fmt::format("{} participants are not a multiple of {}, so the orders are not balanced",
                     plan.participants, block);
}

}  // namespace fogline::trials
