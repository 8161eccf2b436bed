// The questions of standard questionnaires, and the check of an answer.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenario/sections/plans/experiment.h"

namespace fogline::trials {

/// The questionnaire with its questions. If it has the kind "own", these are the questions of the
/// experiment's file. Otherwise they are the questions of a standard questionnaire. The questions
/// of a standard are short labels of Fogline, and not the published wording:
/// - nasa_tlx: the six scales of the NASA Task Load Index (Hart & Staveland 1988), from 0 to 100 in
///   steps of 5. Fogline leaves out the weights of the original. This form is called Raw TLX (Hart
///   2006).
/// - kss: the Karolinska Sleepiness Scale (Akerstedt & Gillberg 1990), from 1 to 9.
QuestionnaireSection WithItems(QuestionnaireSection questionnaire);

/// An answer to an item.
struct Answer {
  double value = 0;  // 0 for a free text
  std::string text;  // "" for a scale
};

/// Reads an answer as a person types it.
/// @param why is set to the allowed answers if the text is not an answer
std::optional<Answer> ReadAnswer(const ItemSection& item, std::string_view text, std::string& why);

}  // namespace fogline::trials
