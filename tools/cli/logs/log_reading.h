// The options of verbs that can read a log with gaps, a log of several runs, or a log without its
// scenario. This file also has the messages that these verbs print about such a log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include "services/log/run_log.h"
#include "tools/runner/scenario_run.h"

namespace fogline::cli {

/// The options --run and --scenario.
class LogReading {
 public:
  explicit LogReading(CLI::App& verb);

  /// The options for reading a log. Logs with gaps are accepted. @throws InputError for an invalid
  /// scenario
  log::ReadOptions Options() const;

 private:
  std::optional<std::int64_t> run_id_;
  std::filesystem::path scenario_;
};

/// The option --run alone.
void AddRunOption(CLI::App& verb, std::optional<std::int64_t>& run_id);

/// @throws InputError always; its text names the log and says why a verb cannot use the log
[[noreturn]] void RefuseLog(const std::filesystem::path& log, const std::string& why);

/// Prints on stderr why a log is not complete, and which other runs it has.
void SayAboutLog(const std::filesystem::path& log, const log::RunLog& run);

/// The gaps of a log as JSON: {"first_step": 0, "steps": 1, "messages": {"RADAR": 1}, "gaps":
/// [{"first_step": 394, "last_step": 394, "channels": ["RADAR"]}], "gaps_left_out": 0}
nlohmann::ordered_json GapsJson(const log::LogGaps& gaps);

/// The digest of a run as JSON: null if it is unknown (log::DigestText()).
nlohmann::ordered_json DigestJson(const log::RunLog& run);

/// The names of the measures of a run that are unknown because its log has gaps.
std::vector<std::string> UnknownMeasures(const runner::RunResult& result);
/// These names as a text, such as "rhe_pct, transfers", or "all measures"; "" if all measures are
/// known.
std::string UnknownMeasuresText(const runner::RunResult& result);

/// A text that says which requests to take over, and which measures of requests, are unknown for a
/// run, such as "the measures of take-overs". The text is "" if all requests and their measures are
/// known, or if the run cannot have requests.
std::string UnknownTakeOvers(const runner::LoggedRun& run);

/// Prints on stderr which results of a run are unknown because its log has gaps.
/// @param of_pair names of the unknown results that need the paired run (pairing.h)
void SayWhatIsUnknown(const runner::LoggedRun& run, const std::string& of_pair = "");

}  // namespace fogline::cli
