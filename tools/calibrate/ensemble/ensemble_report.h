// Makes the texts of an ensemble of parameter sets: scenario files, a table for people, the same
// table as CSV, and JSON for programs.
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

/// The outcome of the searches in two lines, such as "8 of 8 sets ...". If there are several sets,
/// a third line has the least distance of two sets.
std::string EnsembleSummary(const EnsembleReport& report);

/// The scenario's title, the summary and, if there are sets, a table. The table has a column for
/// each set. Its lines are the free and the derived fields, SI and RHE at each threshold, and the
/// distance from the target. SI, RHE and the distance come twice: over the seeds of the search, and
/// over the fresh seeds.
std::string EnsembleText(const EnsembleReport& report);

/// The table of EnsembleText() as CSV.
std::string EnsembleCsv(const EnsembleReport& report);

std::string EnsembleJson(const EnsembleReport& report);

}  // namespace fogline::calibrate
