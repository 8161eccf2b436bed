// Writes the requests to take over of many runs as one CSV file, with a line for each request.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/log/input_latency.h"
#include "services/metrics/take_over/take_over_measures.h"

namespace fogline::exports {

/// The requests of one run.
struct TakeOverRun {
  std::string log;  // may contain any characters
  std::int64_t seed = 0;
  std::vector<metrics::TakeOverMeasures> take_overs;
  // Whether the log lacks messages, so that there may be more requests than `take_overs`.
  bool unknown = false;
  std::optional<log::InputLatency> input_latency;
};

/// Whether WriteTakeOverCsv() could have written the file. Only the beginning of the file is
/// checked.
bool IsTakeOverCsv(const std::filesystem::path& file);

/// Writes a header line, and a line for each request. If a run may have more requests
/// (TakeOverRun::unknown), there is one more line for the run. This line has the outcome "unknown",
/// and neither a number nor measures. The columns are log, seed, request (from 1 on in each log),
/// outcome, the measures of VisitTakeOver(), and the input latency of the run. A value that does
/// not exist is empty. Numbers have enough digits to restore every bit. A name with a comma, a
/// quote or a line end is in quotes (RFC 4180).
/// @throws InputError if the file cannot be created; std::runtime_error when the disk is full;
/// Interrupted
void WriteTakeOverCsv(std::span<const TakeOverRun> runs, const std::filesystem::path& file);

}  // namespace fogline::exports
