// Arguments that several verbs share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include "scenario/loader.h"
#include "services/recorder/log_of_run.h"
#include "services/runtime/build_id.h"
#include "services/runtime/diagnostics.h"
#include "tools/fogline/experiment.h"
#include "tools/sweep/plan.h"

namespace fogline {

/// SCENARIO, --set and --seed.
class ScenarioArguments {
 public:
  explicit ScenarioArguments(CLI::App& verb, bool with_seed = true) {
    verb.add_option("SCENARIO", file_, "Scenario file")->required();
    verb.add_option("--set", overrides_, "Override a field: /arbitrator/threshold=0.8 (repeatable)")
        ->allow_extra_args(false);
    if (with_seed) verb.add_option("--seed", seed_, "Seed instead of the scenario's own");
  }

  /// @throws InputError
  Scenario Load() const {
    std::vector<std::string> overrides = overrides_;
    if (!seed_.empty()) overrides.push_back("/seed=" + seed_);
    Scenario scenario = LoadScenario(file_, overrides);
    CheckPossible(scenario, file_);
    return scenario;
  }
  const std::filesystem::path& file() const { return file_; }

  /// For a verb that varies a field itself: refuses to have it set. `why` says what sets it.
  /// @throws InputError
  void RefuseOverrideOf(std::string_view pointer, std::string_view why) const;

 private:
  std::filesystem::path file_;
  std::vector<std::string> overrides_;
  std::string seed_;  // checked where all fields are
};

/// A log file to write: refuses one that another run is writing, one that has something in it
/// unless `force`, and with it whatever is no event log; requires its folder as RequireFolderOf()
/// does.
/// @throws InputError
LogOfRun PrepareLog(const std::filesystem::path& log, bool force);

/// "logs/STEM-1.lcm", or the first number that is free.
LogOfRun FreshLog(const std::filesystem::path& scenario_file);

/// Calls `work(log)` for each; one that is no log is named on stderr and left out, and the others
/// are worked on all the same. Returns whether there was none of that kind.
template <class Work>
bool ForEachReadable(const std::vector<std::filesystem::path>& logs, const Work& work) {
  bool readable = true;
  for (const std::filesystem::path& log : logs) {
    try {
      work(log);
    } catch (const InputError& error) {
      Complain(error.what());
      readable = false;
    }
  }
  return readable;
}

/// The seeds of --seeds. One number alone, which may be meant for so many seeds, is explained on
/// stderr.
/// @throws InputError
SeedRange ReadSeeds(const std::string& text);

/// --json output: a document and a newline on stdout. Names that are no UTF-8, which JSON cannot
/// carry, have U+FFFD there; what a terminal would obey is escaped.
void PrintJson(const nlohmann::ordered_json& json, int indent = 2);
void PrintJson(const std::string& text);

/// Refuses --json of a verb whose document goes to stdout itself: nothing could tell the two apart.
/// @param option that says where the document goes, such as "--out"; "" for nowhere
/// @throws InputError
void RefuseJsonBeside(const std::filesystem::path& document, std::string_view option, bool json);

/// What a verb says of its result: on stdout, or on stderr if its document goes to stdout.
void PrintBeside(const std::filesystem::path& document, std::string_view text);

/// 16 hexadecimal digits, or null for a build that is not known.
nlohmann::ordered_json BuildJson(BuildId build);

/// --lcm-url of a verb that looks at a network from outside.
class NetworkArguments {
 public:
  /// @param what completes "LCM network ..."
  NetworkArguments(CLI::App& verb, std::string_view what);

  /// The network to look at, by the rule of every program (lcm_url.h).
  /// @throws InputError if the URL names no network that others can look into
  std::string Url() const;
  /// Whether the verb is to follow the runs that are announced there, because the command line
  /// names no network.
  bool Follows() const { return url_.empty(); }

 private:
  std::string url_;
};

/// {"name": value, ...} of a run's measures, to stand in a larger JSON text. With more than one
/// following car "followers" is the list of theirs.
std::string MeasuresJson(const ExperimentResult& result);

/// The measures of a run as lines "name  value unit", and a table of the following cars' where
/// there is more than one.
std::string MeasuresText(const ExperimentResult& result);

/// The same of the figures of a run in real time, and its fallbacks.
nlohmann::ordered_json RealtimeJson(const RealtimeFigures& figures);
std::string RealtimeText(const RealtimeFigures& figures);

}  // namespace fogline
