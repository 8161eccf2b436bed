// Reads the parameter sets in scenario/ensemble, and makes overrides for the scenarios of the
// studies from them. A parameter set is a list of values for fields of a scenario. With the values
// of each set, the scenario paper.json has nearly the same table of results as the paper.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fogline::study {

/// A field of a parameter set.
struct SetField {
  std::string pointer;
  std::string value;        // as in the file
  bool is_derived = false;  // computed from the other fields, so that a run begins in equilibrium
};

struct EnsembleSet {
  std::string name;  // "set 3"
  std::vector<SetField> fields;
};

/// The file with all sets, in the folder of the scenarios.
inline constexpr const char* kSetsFile = "ensemble/sets.csv";

/// The sets, in the order of the file. @throws InputError
std::vector<EnsembleSet> ReadEnsembleSets(const std::filesystem::path& scenarios);

/// The overrides that give a scenario the values of the set. For paper.json these are all fields of
/// the set. Another file describes another experiment, such as another fog and other sensors. So a
/// field that this file contains keeps its value. There are two exceptions. The derived fields (the
/// gaps) have the values of the set, so that a run begins in equilibrium. /acc/standstill_m is
/// computed for the file, because the value of the set includes the error of the fused distance in
/// paper.json.
/// @pre the sensors of another file have no offset
/// @throws InputError
std::vector<std::string> OverridesOf(const EnsembleSet& set, const std::filesystem::path& file);

}  // namespace fogline::study
