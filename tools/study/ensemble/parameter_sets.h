// Reads the parameter sets of scenario/ensemble, and makes overrides of the studies' scenarios from
// them. With each set the paper's experiment meets its published table.
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

/// The overrides with which a scenario has the parameters of the set. For paper.json these are all
/// fields of the set. Another file describes another experiment. So the file keeps the values of
/// fields that it contains, such as its fog and its sensors. But the gaps (the derived fields) come
/// from the set, so that a run begins in equilibrium.
/// @pre the sensors of another file have no offset
/// @throws InputError
std::vector<std::string> OverridesOf(const EnsembleSet& set, const std::filesystem::path& file);

}  // namespace fogline::study
