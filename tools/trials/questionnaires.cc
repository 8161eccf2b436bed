#include "tools/trials/questionnaires.h"

#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "common/parse_number.h"
#include "common/text.h"
#include "services/runtime/wire/trial.h"

namespace fogline::trials {
namespace {

ItemSection Scale(std::string name, std::string text, double min, double max, double step,
                  std::string low, std::string high) {
  ItemSection item;
  item.name = std::move(name);
  item.text = std::move(text);
  item.min = min;
  item.max = max;
  item.step = step;
  item.low = std::move(low);
  item.high = std::move(high);
  return item;
}

/// A scale of the NASA Task Load Index: 21 marks from 0 to 100.
ItemSection TlxScale(std::string name, std::string text, std::string low = "very low",
                     std::string high = "very high") {
  return Scale(std::move(name), std::move(text), 0, 100, 5, std::move(low), std::move(high));
}

bool IsOnScale(const ItemSection& item, double value) {
  constexpr double kRounding = 1e-6;  // share of a step, because 0.1 is not exact in binary
  const double steps = (value - item.min) / item.step;
  return value >= item.min && value <= item.max && std::abs(steps - std::round(steps)) < kRounding;
}

}  // namespace

QuestionnaireSection WithItems(QuestionnaireSection questionnaire) {
  if (questionnaire.kind == QuestionnaireKind::kNasaTlx) {
    questionnaire.items = {
        TlxScale("mental_demand", "Mental demand: how much you had to think and watch"),
        TlxScale("physical_demand", "Physical demand: how much bodily effort it took"),
        TlxScale("temporal_demand", "Temporal demand: how hurried you were"),
        TlxScale("performance", "Performance: how well you did", "perfect", "failure"),
        TlxScale("effort", "Effort: how hard you had to work"),
        TlxScale("frustration", "Frustration: how annoyed or stressed you were"),
    };
  }
  if (questionnaire.kind == QuestionnaireKind::kKss) {
    questionnaire.items = {Scale("sleepiness", "How sleepy you are now", 1, 9, 1, "fully awake",
                                 "very sleepy, fighting sleep")};
  }
  return questionnaire;
}

std::optional<Answer> ReadAnswer(const ItemSection& item, std::string_view text, std::string& why) {
  if (item.kind == ItemKind::kText) {
    if (!IsUtf8(text) || HasControlCharacter(text)) {
      why = "a text without control characters";
      return std::nullopt;
    }
    if (text.size() > runtime::kMostTrialTextBytes) {
      why = fmt::format("a text of at most {} bytes", runtime::kMostTrialTextBytes);
      return std::nullopt;
    }
    return Answer{.value = 0, .text = std::string(text)};
  }
  const auto value = ParseNumber<double>(text);
  if (value && IsOnScale(item, *value)) return Answer{.value = *value, .text = ""};
  why = fmt::format("a number from {} to {} in steps of {}", NumberText(item.min),
                    NumberText(item.max), NumberText(item.step));
  return std::nullopt;
}

}  // namespace fogline::trials
