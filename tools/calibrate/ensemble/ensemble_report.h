// An ensemble of parameter sets as scenario files, as a table for people and for spreadsheets, and
// as JSON for programs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "tools/calibrate/ensemble/ensemble.h"

namespace fogline::calibrate {

/// What is known of an ensemble and of the search for it.
struct EnsembleReport {
  const Objective& searched;
  const Objective& fresh;
  const EnsembleRules& rules;
  ParameterEnsemble found;
  std::string scenario;  // the file's name
  std::string command;   // that makes the same ensemble again
};

/// "set-3.json" for index 2.
std::string SetFileName(std::size_t index);

/// `text`, the file of the problem's scenario, with the title and the description of a set. They
/// say how the set was made.
std::string WithOrigin(const EnsembleReport& report, std::size_t index, std::string_view text);

/// The same with the values of the set: the set as a file.
std::string SetText(const EnsembleReport& report, std::size_t index, std::string_view text);

/// "8 of 8 sets ...": what became of the searches, in two lines.
std::string EnsembleSummary(const EnsembleReport& report);

/// The summary and a table: a line for each field and for each number of the tables, a column for
/// each set.
std::string EnsembleText(const EnsembleReport& report);

/// The same table as CSV.
std::string EnsembleCsv(const EnsembleReport& report);

std::string EnsembleJson(const EnsembleReport& report);

}  // namespace fogline::calibrate
