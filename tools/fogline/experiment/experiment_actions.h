// Actions of `fogline experiment` that have a file of their own, and the arguments that all actions
// have.
#pragma once

#include <filesystem>
#include <system_error>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/text.h"
#include "tools/cli/action.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/trials/plan_file.h"

namespace fogline {

/// The arguments FILE and --results.
class PlanArguments {
 public:
  explicit PlanArguments(CLI::App& verb) {
    verb.add_option("FILE", file_, "File of the experiment")->required();
    verb.add_option("--results", results_, "Folder with the logs (default: logs/NAME-OF-FILE)");
  }

  trials::PlanFile Load() const { return trials::LoadPlan(file_); }
  std::filesystem::path results() const {
    return results_.empty() ? std::filesystem::path(kDefaultFolder) / file_.stem() : results_;
  }
  /// @throws InputError if --results names no folder
  void RequireResults() const {
    std::error_code missing;
    if (results_.empty() || std::filesystem::exists(results_, missing)) return;
    throw InputError(
        fmt::format("{}: error: --results: there is no such folder", PathText(results_)));
  }

 private:
  std::filesystem::path file_;
  std::filesystem::path results_;
};

/// Adds `fogline experiment run`.
void AddRunTrials(CLI::App& experiment, cli::Action& action);

}  // namespace fogline
