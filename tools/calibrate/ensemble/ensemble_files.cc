#include "tools/calibrate/ensemble/ensemble_files.h"

#include <optional>
#include <regex>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/text.h"
#include "scenario/io/json.h"
#include "tools/calibrate/scenario_text.h"

namespace fogline::calibrate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTableName = "sets.csv";

/// The scenario files of sets ("set-1.json" and so on) in a folder.
std::vector<fs::path> SetsIn(const fs::path& folder) {
  static const std::regex name("set-[1-9][0-9]*\\.json");
  std::vector<fs::path> sets;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    if (std::regex_match(entry.path().filename().string(), name)) sets.push_back(entry.path());
  }
  return sets;
}

void WriteWhole(const fs::path& path, const std::string& content) {
  AtomicFile file(path);
  file.Write(content);
  file.Finish();
}

}  // namespace

std::string WithSchemaIn(const fs::path& to, const fs::path& from, std::string text) {
  DiagnosticList ignored;
  const std::optional<JsonValue> root = ParseJson(text, 0, ignored);
  const auto* object = root ? root->As<JsonObject>() : nullptr;
  const JsonMember* member = object ? FindMember(*object, "$schema") : nullptr;
  const auto* schema = member ? member->value.As<std::string>() : nullptr;
  if (schema == nullptr || schema->find(':') != schema->npos || fs::path(*schema).is_absolute()) {
    return text;
  }
  return WithValue(text, "/$schema", Quote(fs::proximate(from / *schema, to).string()));
}

EnsembleFolder::EnsembleFolder(fs::path folder, bool force)
    : folder_(std::move(folder)), checked_(folder_, "--out") {
  if (force || SetsIn(folder_).empty()) return;
  throw InputError(fmt::format("{}: error: --out: the folder has sets; --force replaces them",
                               PathText(folder_)));
}

void EnsembleFolder::Write(const EnsembleReport& report, const std::string& text) const {
  for (const fs::path& old : SetsIn(folder_)) fs::remove(old);
  for (std::size_t i = 0; i < report.found.sets.size(); ++i) {
    WriteWhole(folder_ / SetFileName(i), SetText(report, i, text));
  }
  WriteWhole(folder_ / kTableName, EnsembleCsv(report));
}

}  // namespace fogline::calibrate
