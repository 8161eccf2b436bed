// What a run has come to, as `fogline run` prints it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tools/fogline/experiment.h"

namespace fogline {

struct RunOutcome {
  std::filesystem::path file;  // that has the scenario
  std::int64_t steps = 0;      // of the scenario; a collision ends a run before them
  ExperimentResult result;
  std::optional<std::int64_t> resumed;  // steps that were in the log before
  bool computed = true;                 // the rest of them, here
};

nlohmann::ordered_json ToJson(const RunOutcome& outcome);
/// Some lines; the first one says the most.
std::string ToText(const RunOutcome& outcome);

}  // namespace fogline
