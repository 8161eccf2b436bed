// Reads, checks, prints and explains scenarios. All mistakes of a scenario are reported together.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/errors.h"
#include "scenario/sections/scenario.h"

namespace fogline {

/// One mistake in a scenario.
struct Diagnostic {
  std::string file;     // the file's name, or an override such as "--set /seed=x"
  int line = 0;         // 1-based; 0 for an override and for a file that cannot be read
  int column = 0;       // 1-based, in characters
  std::string pointer;  // JSON pointer of the field, such as /arbitrator/threshold
  std::string rule;     // stable name of the broken rule, such as "range" (scenario/README.md)
  std::string message;  // the mistake, the allowed values, and a suggestion
  std::size_t override_number = 0;  // 1-based number of the override with the mistake; 0: the file
};

/// A scenario that breaks rules. what() has one line for each mistake (20 at most), as
/// `file:line:column: error: /pointer: message`. The mistakes of the file come first, in the file's
/// order. Then come the mistakes of the overrides, and the number of all mistakes. diagnostics()
/// has an entry for each mistake, at least 1 and at most 1000.
class ScenarioError : public InputError {
 public:
  ScenarioError(const std::string& text, std::vector<Diagnostic> diagnostics)
      : InputError(text), diagnostics_(std::move(diagnostics)) {}
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// Reads a scenario file and applies `overrides` ("/arbitrator/threshold=0.8", as after --set)
/// before all checks. If the leader is recorded and lead.recorded.speeds_mps is empty, the function
/// reads the CSV file (relative to the scenario's folder). Then the function fills speeds_mps with
/// the speeds at steps 0 to steps - 1, interpolated linearly. If the leader comes from SUMO, the
/// function fills lead.sumo.net and lead.sumo.routes in the same way with the lines of their files.
/// @throws ScenarioError
Scenario LoadScenario(const std::filesystem::path& file,
                      const std::vector<std::string>& overrides = {});

/// Does the same as LoadScenario() for a text in memory, but reads no other file. Messages show
/// `name` as the file's name.
/// @throws ScenarioError
Scenario ParseScenario(std::string_view text, std::string_view name = "scenario",
                       const std::vector<std::string>& overrides = {});

/// The effective scenario: JSON with every default written out, and a line feed at the end. Equal
/// scenarios give equal text, and ParseScenario(PrintScenario(s)) equals s bit by bit.
/// @pre every value of `scenario` is within the range of its field
std::string PrintScenario(const Scenario& scenario);

/// JSON schema (draft-07) of scenario files, made from the descriptions of the fields. For JSON
/// documents without duplicate keys, the schema and ParseScenario() agree: both accept a document,
/// or both refuse it.
std::string ScenarioSchema();

/// JSON schema (draft-07) of the files of experiments with people (sections/plans/experiment.h).
std::string ExperimentSchema();

/// JSON schema (draft-07) of the files of laboratories (sections/plans/lab.h).
std::string LabSchema();

/// Explanation of a field or section for a person: meaning, type, unit, range, default, source. "/"
/// or "" is the whole scenario; an item of a list is /published/0 or /published/*.
/// @throws InputError if there is no such field
std::string ExplainField(std::string_view pointer);

}  // namespace fogline
