#include "tools/study/ensemble/parameter_sets.h"

#include <fstream>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/errors.h"
#include "common/text.h"
#include "scenario/io/loader.h"
#include "tools/study/engagement/calibrated_radar.h"

namespace fogline::study {
namespace {

// The first columns of the file are quantity, unit, lowest value, highest value and scale. Then
// comes a column for each set.
constexpr std::size_t kScale = 4;
constexpr std::size_t kFirstSet = 5;

std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

[[noreturn]] void RefuseSets(const std::filesystem::path& file, std::string_view why) {
  throw InputError(fmt::format("{}: error: {}", PathText(file), why));
}

}  // namespace

std::vector<EnsembleSet> ReadEnsembleSets(const std::filesystem::path& scenarios) {
  const std::filesystem::path file = scenarios / kSetsFile;
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> columns = CellsOf(line);
  if (columns.size() <= kFirstSet) RefuseSets(file, "there is no parameter set");
  std::vector<EnsembleSet> sets;
  for (std::size_t i = kFirstSet; i < columns.size(); ++i) {
    sets.push_back({.name = fmt::format("set {}", i - kFirstSet + 1), .fields = {}});
  }
  while (std::getline(stream, line)) {
    // Only the rows of fields begin with a slash. The other rows have the results of each set: SI,
    // RHE and the distance from the target.
    if (!line.starts_with('/')) continue;
    const std::vector<std::string> cells = CellsOf(line);
    if (cells.size() != columns.size()) RefuseSets(file, "a set has no value of " + cells[0]);
    for (std::size_t i = 0; i < sets.size(); ++i) {
      sets[i].fields.push_back({.pointer = cells[0],
                                .value = cells[kFirstSet + i],
                                .is_derived = cells[kScale] == "derived"});
    }
  }
  return sets;
}

std::vector<std::string> OverridesOf(const EnsembleSet& set, const std::filesystem::path& file) {
  std::vector<std::string> overrides;
  const bool is_paper = file.filename() == "paper.json";
  const nlohmann::json stated =
      is_paper ? nlohmann::json() : nlohmann::json::parse(std::ifstream(file));
  for (const SetField& field : set.fields) {
    const bool keeps =
        !field.is_derived && stated.contains(nlohmann::json::json_pointer(field.pointer));
    if (!keeps) overrides.push_back(fmt::format("{}={}", field.pointer, field.value));
  }
  // The set's own standstill gap includes the error of the fused distance in paper.json. The
  // sensors of another file have no offset, so this gap is computed again.
  if (!is_paper) {
    const double standstill_m = StandstillWithoutOffset(LoadScenario(file, overrides));
    overrides.push_back(fmt::format("/acc/standstill_m={:.4f}", standstill_m));
  }
  return overrides;
}

}  // namespace fogline::study
