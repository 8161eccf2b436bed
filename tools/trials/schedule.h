// The trials of a participant, and their order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scenario/sections/plans/experiment.h"

namespace fogline::trials {

/// A trial or practice run of a participant.
struct Trial {
  std::int64_t participant = 1;
  bool practice = false;
  std::int64_t number = 1;  // position in the order, from 1; practice runs are counted separately
  std::size_t index = 0;    // index of its condition in `practice` or `conditions`
  std::int64_t seed = -1;   // -1: the seed of the condition's scenario
};

/// The condition of a trial. @pre the trial is of this plan
const ConditionSection& ConditionOf(const ExperimentPlan& plan, const Trial& trial);

/// The practice runs and trials of a participant, in the order in which they are made.
/// @param participant from 1 to plan.participants
std::vector<Trial> ScheduleOf(const ExperimentPlan& plan, std::int64_t participant);

/// The questions after a trial, in their order. A standard questionnaire, such as nasa_tlx, is
/// returned with the items of the standard.
std::vector<QuestionnaireSection> QuestionsAfter(const ExperimentPlan& plan, const Trial& trial);

/// Least time between a trial and the next one, s; 0 without a break.
double BreakAfter(const ExperimentPlan& plan, const Trial& trial);

/// The conditions of a participant's trials in their order, joined by spaces.
std::string OrderText(const ExperimentPlan& plan, std::int64_t participant);

/// A remark if the number of participants leaves the order unbalanced; "" if it is balanced.
std::string BalanceRemark(const ExperimentPlan& plan);

}  // namespace fogline::trials
