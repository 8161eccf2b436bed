// The parameter sets of scenario/ensemble, with which the paper's experiment meets its published
// table, as overrides of the studies' scenarios.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fogline::study {

/// A field of a parameter set.
struct SetField {
  std::string pointer;
  std::string value;        // as in the file
  bool is_derived = false;  // it follows from the other fields, so that a run begins in equilibrium
};

struct EnsembleSet {
  std::string name;  // "set 3"
  std::vector<SetField> fields;
};

/// The file with all sets, in the folder of the scenarios.
inline constexpr const char* kSetsFile = "ensemble/sets.csv";

/// The sets, in the order of the file. @throws InputError
std::vector<EnsembleSet> ReadEnsembleSets(const std::filesystem::path& scenarios);

/// The overrides with which a scenario has the parameters of the set. In paper.json it has all of
/// them. Another file keeps the fields that it sets, such as its fog and its sensors, because it
/// describes another experiment; only the gaps follow from the set, so that a run begins in
/// equilibrium. @pre the sensors of another file have no offset
/// @throws InputError
std::vector<std::string> OverridesOf(const EnsembleSet& set, const std::filesystem::path& file);

}  // namespace fogline::study
