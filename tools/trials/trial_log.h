// The facts of a trial in its log (lcmtypes/trial_t.lcm). The recorder writes the facts that come
// during the run. The functions of this file add facts that come after the run, such as answers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fogline/trial_t.hpp"
#include "scenario/sections/scenario.h"
#include "services/log/log_seal.h"
#include "services/runtime/wire/message_signer.h"

namespace fogline::trials {

/// The progress of a trial.
enum class TrialState {
  kOpen,    // not begun
  kBroken,  // the run broke off; the trial is run again
  kToAsk,   // the run is complete, but answers are missing
  kDone,
};
std::string NameOf(TrialState state);

/// The facts about a trial in its log.
struct TrialStory {
  TrialState state = TrialState::kBroken;
  std::int64_t run_id = 0;
  std::int64_t steps = 0;
  std::int64_t last_utime = 0;       // simulated time of the last step, us
  double speed = 1;                  // simulated seconds per second
  std::string note;                  // fault of the log; "" if it has none; see FaultText()
  std::vector<trial_t> facts;        // each fact once, by its sequence
  std::optional<Scenario> scenario;  // none if the log cannot be read
  std::optional<log::LogSeal> seal;  // none if the run broke off
  bool altered = false;              // the log differs from its seal
};

/// Reads a log. A log that cannot be read counts as the log of a broken run, and the note says why.
TrialStory ReadStory(const std::filesystem::path& log);

/// A text with the path and the fault of a log, such as "trial-1-fog.lcm: the log ends after step
/// 4".
std::string FaultText(const std::filesystem::path& log, const TrialStory& story);

/// @throws std::runtime_error if a text of the fact is too long, or a number is out of range:
///     recorder and readers ignore such a fact (runtime::WrongIn)
void RequireReadable(const trial_t& fact);

/// Adds facts to the log of a complete run, and seals it again. Facts with a sequence number that
/// the log already has are left out. The log is replaced as a whole, so a crash leaves the old log
/// or the new one.
/// @param story of the log
/// @param key signs the seal; nullptr: no signature
/// @throws std::runtime_error as RequireReadable(), and if the log was altered after it was sealed,
///     or cannot be written
void AddFacts(const std::filesystem::path& log, const TrialStory& story,
              const std::vector<trial_t>& facts, const runtime::SigningKey* key);

}  // namespace fogline::trials
