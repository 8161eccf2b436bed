// An experiment as tables for statistics: a row for each trial, and a row for each value.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tools/trials/results.h"

namespace fogline::trials {

struct Tables {
  /// A row for each trial that has a log. The first columns describe the trial: participant, trial,
  /// condition, log and so on. Then comes one column for each item of a questionnaire. The last
  /// columns are the measures of the run, of its first request to take over, and of the latency of
  /// a person's inputs.
  std::string trials;
  /// A row for each answer, measure and marker: participant, trial, practice, condition, kind,
  /// item, value, unit, time_s.
  std::string values;
  std::int64_t rows = 0;            // of `trials`
  std::int64_t missing = 0;         // trials that are not done, practice runs included
  std::vector<std::string> faults;  // one for the log of each broken run, as "LOG: fault"
};

/// Reads the newest log of each trial. Cells without a value are empty. Texts are quoted as in RFC
/// 4180. Each line ends with a line feed.
Tables MakeTables(const PlanFile& plan, const Results& results);

/// Whether the file is one of these tables.
bool IsTrialTable(const std::filesystem::path& file);

/// A time as text, such as "2026-11-23T15:04:05Z". @param unix_us microseconds since 1970 (UTC)
std::string UtcText(std::int64_t unix_us);

}  // namespace fogline::trials
