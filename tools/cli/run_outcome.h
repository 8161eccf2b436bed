// The result of a run, as `fogline run` prints it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "tools/runner/scenario_run.h"

namespace fogline::cli {

struct RunOutcome {
  std::filesystem::path file;  // the file with the scenario
  std::int64_t steps = 0;      // steps of the scenario; a collision may end a run earlier
  runner::RunResult result;
  std::optional<std::int64_t> resumed;  // steps that the log already had, for --resume
  bool computed = true;                 // whether this process computed any steps
};

nlohmann::ordered_json ToJson(const RunOutcome& outcome);
/// Several lines, the most important line first.
std::string ToText(const RunOutcome& outcome);

/// The exit code of a run that has ended. If it is not kDone, the reason is printed on stderr.
/// @param verb name of the verb, for the text of an error
/// @throws std::runtime_error if the log of a run in real time lacks published messages
int EndOf(const runner::RunResult& result, std::string_view verb);

/// Prints the outcome of a run on stdout, and the reason of a failure on stderr.
/// @param verb name of the verb, for the text of an error
/// @return the exit code
/// @throws std::runtime_error if the log of a run in real time lacks published messages
int PrintOutcome(const RunOutcome& outcome, bool json, std::string_view verb);

}  // namespace fogline::cli
