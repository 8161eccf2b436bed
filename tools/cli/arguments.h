// Arguments that several verbs share.
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include "common/clock.h"
#include "common/process/console.h"
#include "scenario/io/loader.h"
#include "services/runtime/wire/build_id.h"
#include "tools/runner/scenario_run.h"
#include "tools/sweep/plan.h"

namespace fogline::cli {

/// The duration that an option gives in seconds.
inline Duration FromSeconds(double seconds) {
  return duration_cast<Duration>(std::chrono::duration<double>(seconds));
}

/// Refuses a --set of a field that the verb itself varies. `why` says what sets the field.
/// @throws InputError
void RefuseOverride(std::span<const std::string> overrides, std::string_view pointer,
                    std::string_view why);

/// The arguments SCENARIO, --set and --seed.
class ScenarioArguments {
 public:
  explicit ScenarioArguments(CLI::App& verb, bool with_seed = true) {
    verb.add_option("SCENARIO", file_, "Scenario file")->required();
    verb.add_option("--set", overrides_, "Override a field: /arbitrator/threshold=0.8 (repeatable)")
        ->allow_extra_args(false);
    if (with_seed) verb.add_option("--seed", seed_, "Seed instead of the scenario's own");
  }

  /// @param more overrides of the verb itself. They have precedence over the overrides of the user
  /// @throws InputError
  Scenario Load(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> overrides = overrides_;
    overrides.insert(overrides.end(), more.begin(), more.end());
    if (!seed_.empty()) overrides.push_back("/seed=" + CheckedSeed());
    Scenario scenario = LoadScenario(file_, overrides);
    runner::CheckPossible(scenario, file_);
    return scenario;
  }
  const std::filesystem::path& file() const { return file_; }

  /// Whether the user has given this override, such as "/person/drives=false".
  bool HasOverride(std::string_view text) const {
    return std::ranges::find(overrides_, text) != overrides_.end();
  }

  /// Refuses a --set of this field, as RefuseOverride() does.
  void RefuseOverrideOf(std::string_view pointer, std::string_view why) const {
    RefuseOverride(overrides_, pointer, why);
  }

 private:
  /// The text of --seed. @throws InputError if the text is not a seed
  const std::string& CheckedSeed() const;

  std::filesystem::path file_;
  std::vector<std::string> overrides_;
  std::string seed_;
};

/// Calls `work(log)` for each log. If a log cannot be read, the error is printed on stderr, and the
/// work continues with the other logs. @return whether all logs could be read
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

/// The seeds of --seeds. A single number is one seed. If the number is above 1, the user may have
/// meant a count, so the function explains on stderr how to write a range.
/// @throws InputError
sweep::SeedRange ReadSeeds(const std::string& text);

/// Prints --json output: a document and a newline on stdout. In a name that is not UTF-8, U+FFFD
/// replaces the bytes that are not allowed in JSON. Control characters for terminals are escaped.
void PrintJson(const nlohmann::ordered_json& json, int indent = 2);
void PrintJson(const std::string& text);

/// Refuses --json if the verb's document goes to stdout, because a reader could not separate the
/// two texts.
/// @param document the file of the document; "" if there is no document
/// @param option the option that names this file, such as "--out"
/// @throws InputError
void RefuseJsonBeside(const std::filesystem::path& document, std::string_view option, bool json);

/// Prints a verb's text about its result. It goes to stdout, or to stderr if the verb's document
/// goes to stdout.
void PrintBeside(const std::filesystem::path& document, std::string_view text);

/// A build as 16 hexadecimal digits; null for an unknown build.
nlohmann::ordered_json BuildJson(runtime::BuildId build);

/// The URL of the network of a verb that observes other processes, or sends messages to them. Every
/// program finds its network by the same rule (lcm_url.h).
/// @param given the URL from --lcm-url; "" without --lcm-url
/// @throws InputError if the URL is wrong, or no other process can reach the network (memq)
std::string CheckedNetworkUrl(const std::string& given);

/// The option --lcm-url of a verb that observes a network from outside.
class NetworkArguments {
 public:
  /// @param what the words that follow "LCM network" in the help text, such as "to examine"
  NetworkArguments(CLI::App& verb, std::string_view what);

  /// The URL of the network to observe. @throws InputError as CheckedNetworkUrl()
  std::string Url() const { return CheckedNetworkUrl(url_); }
  /// Whether the verb should follow announced runs: true if the command line names no network.
  bool Follows() const { return url_.empty(); }

 private:
  std::string url_;
};

}  // namespace fogline::cli
