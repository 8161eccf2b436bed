// An ensemble of parameter sets as scenario files, as a table for people and for spreadsheets, and
// as JSON for programs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "tools/calibrate/ensemble/ensemble.h"

namespace fogline::calibrate {

/// An ensemble, and the search that found it.
struct EnsembleReport {
  const Objective& searched;
  const Objective& fresh;
  const EnsembleRules& rules;
  ParameterEnsemble found;
  std::string scenario;  // name of the scenario's file
  std::string command;   // command that finds the same ensemble again
};

/// Name of the file of the set with this index: "set-3.json" for index 2.
std::string SetFileName(std::size_t index);

/// `text` with the title and the description of a set. `text` is the text of the scenario's file.
/// The description says how the set was made.
std::string WithOrigin(const EnsembleReport& report, std::size_t index, std::string_view text);

/// The text of a set's file: WithOrigin() with the values of the set.
std::string SetText(const EnsembleReport& report, std::size_t index, std::string_view text);

/// The outcome of the searches in two lines, such as "8 of 8 sets ...".
std::string EnsembleSummary(const EnsembleReport& report);

/// The summary and a table. The table has a line for each field and for each number of the sets'
/// tables, and a column for each set.
std::string EnsembleText(const EnsembleReport& report);

/// The table of EnsembleText() as CSV.
std::string EnsembleCsv(const EnsembleReport& report);

std::string EnsembleJson(const EnsembleReport& report);

}  // namespace fogline::calibrate
