// Short runs in the process of a test, and the contents of their logs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenario/io/loader.h"
#include "services/log/run_log.h"
#include "tests/support/command.h"
#include "tools/runner/scenario_run.h"

namespace fogline::test {

/// The first steps of the paper's scenario.
inline Scenario Paper(std::int64_t steps, std::vector<std::string> overrides = {}) {
  overrides.push_back("/steps=" + std::to_string(steps));
  return LoadScenario(SourceDirectory() / "scenario/paper.json", overrides);
}

inline runner::RunOptions Direct(const std::filesystem::path& log) {
  runner::RunOptions options;
  options.transport = "direct";
  options.log = log;
  return options;
}

/// The contents of a log except its steps.
inline log::RunLog ReadToTheEnd(const std::filesystem::path& file) {
  log::RunLogReader reader(file);
  while (reader.Next() != nullptr) {
  }
  return reader.run();
}

}  // namespace fogline::test
