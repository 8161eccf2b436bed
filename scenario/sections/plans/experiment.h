// The fields of an experiment with people: the scenarios that the participants drive, the order,
// and the questions. tools/trials/plan_file.h reads and checks the JSON files.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenario/sections/field.h"

namespace fogline {

/// A condition of the experiment: a scenario, and changes of its fields.
struct ConditionSection {
  FOGLINE_FIELD(std::string, name, "",
                "Name of the condition, in files and tables: a to z, 0 to 9, - and _.");
  FOGLINE_FIELD(std::string, scenario, "",
                "Scenario file; a relative name is relative to the folder of this file.");
  FOGLINE_FIELD(std::vector<std::string>, set, {}, {0, 100},
                "Fields that differ from the scenario, as after --set: /arbitrator/threshold=0.8.");
};

/// A pause for the participant.
struct BreakSection {
  FOGLINE_FIELD(std::int64_t, after_trial, 1, {1, 100},
                "The break follows this trial; practice runs do not count.",
                "our choice, because a break is after the first trial if nothing else is said");
  FOGLINE_FIELD(double, at_least_s, 60, {0, 86400, "s"},
                "The next trial does not begin before this time is over.",
                "our choice, because a person needs about a minute to stand up and sit down again");
};

enum class ItemKind { kScale, kText };
constexpr auto ChoicesOf(ItemKind) {
  return std::to_array<Choice>({{"scale", "a number from min to max, in steps of step"},
                                {"text", "a free text, which may be empty"}});
}

/// A question of a questionnaire of kind `own`.
struct ItemSection {
  FOGLINE_FIELD(std::string, name, "",
                "Name of the item, in logs and tables: a to z, 0 to 9, - and _.");
  FOGLINE_FIELD(std::string, text, "", "The question, as the participant sees it.");
  FOGLINE_FIELD(ItemKind, kind, ItemKind::kScale, "Kind of the answer.");
  FOGLINE_FIELD(double, min, 1, {-1e6, 1e6}, "Least answer of a scale.",
                "our choice, because usual rating scales go from 1 to 7");
  FOGLINE_FIELD(double, max, 7, {-1e6, 1e6}, "Greatest answer of a scale.",
                "our choice, because usual rating scales go from 1 to 7");
  FOGLINE_FIELD(double, step, 1, {1e-6, 1e6}, "Distance between two answers of a scale.",
                "our choice, because usual rating scales have whole numbers");
  FOGLINE_FIELD(std::string, low, "", "Label of the least answer.");
  FOGLINE_FIELD(std::string, high, "", "Label of the greatest answer.");
  FOGLINE_FIELD(std::string, unit, "", "Unit of the answer, for tables.");
};

enum class QuestionnaireKind { kNasaTlx, kKss, kOwn };
constexpr auto ChoicesOf(QuestionnaireKind) {
  return std::to_array<Choice>(
      {{"nasa_tlx",
        "NASA Task Load Index without weights: six scales from 0 to 100 (Hart & Staveland 1988)"},
       {"kss", "Karolinska Sleepiness Scale: 1 to 9 (Akerstedt & Gillberg 1990)"},
       {"own", "the questions in items"}});
}

enum class AskedAfter { kEachTrial, kLastTrial };
constexpr auto ChoicesOf(AskedAfter) {
  return std::to_array<Choice>({{"each_trial", "after each trial"},
                                {"last_trial", "after the last trial of the participant"}});
}

/// Questions that a participant answers after a trial.
struct QuestionnaireSection {
  FOGLINE_FIELD(std::string, name, "",
                "Name of the questionnaire, in logs and tables: a to z, 0 to 9, - and _.");
  FOGLINE_FIELD(QuestionnaireKind, kind, QuestionnaireKind::kOwn, "Kind of questionnaire.");
  FOGLINE_FIELD(AskedAfter, after, AskedAfter::kEachTrial, "When it is asked.");
  FOGLINE_FIELD(bool, practice, false, "Whether it is also asked after each practice run.");
  FOGLINE_FIELD(std::vector<ItemSection>, items, {}, {0, 50}, "For own: the questions.");
};

enum class TrialOrder { kWilliams, kAsListed };
constexpr auto ChoicesOf(TrialOrder) {
  return std::to_array<Choice>(
      {{"williams",
        "balanced Latin squares: each condition is equally often at each place and after each "
        "other condition (Williams 1949)"},
       {"as_listed", "the order of the file, for every participant"}});
}

enum class TrialSeeds { kScenario, kTrial };
constexpr auto ChoicesOf(TrialSeeds) {
  return std::to_array<Choice>(
      {{"scenario", "the seed of the condition's scenario"},
       {"trial", "first_seed + (participant - 1) * (number of conditions) + (trial - 1)"}});
}

/// An experiment with people, as its file describes it.
struct ExperimentPlan {
  FOGLINE_FIELD(std::int64_t, version, 1, {1, 1}, "Version of the file format.",
                "the only version so far");
  FOGLINE_FIELD(std::string, title, "", "Title: the subject of the experiment in a few words.");
  FOGLINE_FIELD(std::string, description, "", "Question, method and source.");
  FOGLINE_FIELD(std::int64_t, participants, 1, {1, 9999},
                "Number of participants. They have numbers from 1 on, and no names.",
                "our choice, because an experiment has at least one participant");
  FOGLINE_FIELD(TrialOrder, order, TrialOrder::kWilliams, "Order of the conditions.");
  FOGLINE_FIELD(TrialSeeds, seeds, TrialSeeds::kScenario, "Seed of each trial.");
  FOGLINE_FIELD(std::int64_t, first_seed, 1, {0, 1'000'000'000'000},
                "For trial: seed of the first trial of participant 1.",
                "our choice, because counting begins with 1");
  FOGLINE_FIELD(double, speed, 1, {0.01, 100},
                "Simulated seconds per second of each run. A person drives at speed 1.",
                "our choice, because at speed 1 simulated and real time pass equally fast, as a "
                "person needs");
  FOGLINE_FIELD(std::vector<ConditionSection>, conditions, {}, {1, 20}, "The conditions.");
  FOGLINE_FIELD(std::vector<ConditionSection>, practice, {}, {0, 20},
                "Practice runs before the first trial, in this order.");
  FOGLINE_FIELD(std::vector<BreakSection>, breaks, {}, {0, 100}, "Breaks between trials.");
  FOGLINE_FIELD(std::vector<QuestionnaireSection>, questionnaires, {}, {0, 20},
                "Questionnaires, in the order in which they are asked.");
};

}  // namespace fogline
