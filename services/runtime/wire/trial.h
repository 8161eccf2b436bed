// The limits of the contents of a TRIAL message. All programs that send or read TRIAL messages use
// these limits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "services/runtime/wire/refusals.h"

namespace fogline::runtime {

/// The largest length in bytes of the title of an experiment, of the unit of an answer, and of the
/// name of a condition, a questionnaire or an item of a questionnaire.
inline constexpr std::size_t kMostTrialNameBytes = 100;
/// Longest text of a marker or of an answer, in bytes. A TRIAL with such a text fits into one
/// datagram.
inline constexpr std::size_t kMostTrialTextBytes = 500;
/// A recorder logs at most kMostTrialFactsPerSecond TRIAL messages in a second, after a burst of at
/// most kMostTrialFactsAtOnce. Our choice: a person causes fewer messages, and a flood of messages
/// cannot fill the memory or the disk.
inline constexpr double kMostTrialFactsPerSecond = 20;
inline constexpr double kMostTrialFactsAtOnce = 40;

/// Checks whether every number and text of the message is in its range.
/// @return nullptr if all are in their range; otherwise the counter for the refusal
inline RefusalCounter WrongIn(const trial_t& fact) {
  const auto is_short = [](const std::string& text) { return text.size() <= kMostTrialNameBytes; };
  const bool sound = fact.header.step >= -1 && fact.kind >= trial_t::BEGIN &&
                     fact.kind <= trial_t::END && fact.sequence >= 0 && fact.participant >= 1 &&
                     fact.trial >= 1 && fact.attempt >= 1 && is_short(fact.experiment) &&
                     is_short(fact.experiment_hash) && is_short(fact.condition) &&
                     is_short(fact.questionnaire) && is_short(fact.item) && is_short(fact.unit) &&
                     fact.text.size() <= kMostTrialTextBytes;
  return sound ? nullptr : &status_t::out_of_range;
}

/// The beginning of the text, as long as a TRIAL allows. A character of UTF-8 is not cut in two.
inline std::string CutForTrial(std::string_view text) {
  if (text.size() <= kMostTrialTextBytes) return std::string(text);
  std::size_t end = kMostTrialTextBytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) >> 6U) == 2) --end;
  return std::string(text.substr(0, end));
}

}  // namespace fogline::runtime
