// Scenario files: reading with every mistake reported at once, overriding, and writing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.h"

namespace fogline {

/// One mistake in a scenario file.
struct Mistake {
  int line = 0;  // 1-based; 0 when the mistake has no place in the file (an override)
  int column = 0;
  std::string pointer;  // JSON pointer of the field, such as /arbitrator/threshold
  std::string rule;     // stable name of the broken rule, such as "range" or "unknown-key"
  std::string message;
};

/// Bad input of a user: a program prints what() and exits with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A scenario file that breaks rules; what() has a line for each mistake (20 at most), in the order
/// of the file, as `file:line:column: error: /pointer: message`.
class ScenarioError : public InputError {
 public:
  ScenarioError(const std::string& text, std::vector<Mistake> mistakes)
      : InputError(text), mistakes_(std::move(mistakes)) {}
  const std::vector<Mistake>& mistakes() const { return mistakes_; }

 private:
  std::vector<Mistake> mistakes_;
};

/// Reads a scenario file, applies `overrides` ("/arbitrator/threshold=0.8", as of --set), and
/// resolves a recorded leader's CSV file (relative to the scenario's folder) into
/// lead.recorded.speeds_mps.
/// @throws ScenarioError, InputError (file missing or unreadable, bad override, bad CSV)
Scenario LoadScenario(const std::filesystem::path& file,
                      const std::vector<std::string>& overrides = {});

/// The same for text in memory; `name` stands for the file in messages. Resolves no CSV file.
/// @throws ScenarioError, InputError
Scenario ParseScenario(std::string_view text, std::string_view name = "scenario",
                       const std::vector<std::string>& overrides = {});

/// The effective scenario: JSON with every default written out. Equal scenarios give equal text,
/// and ParseScenario(PrintScenario(s)) gives s back, bit by bit.
std::string PrintScenario(const Scenario& scenario);

/// JSON schema (draft-07) of scenario files, made from the same field descriptions.
std::string ScenarioSchema();

}  // namespace fogline
