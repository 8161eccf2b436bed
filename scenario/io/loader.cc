#include "scenario/io/loader.h"

#include <optional>
#include <utility>

#include <fmt/core.h>

#include "common/file.h"
#include "common/text.h"
#include "scenario/io/diagnostic_list.h"
#include "scenario/io/files/recorded.h"
#include "scenario/io/files/sumo_files.h"
#include "scenario/io/json.h"
#include "scenario/io/overrides.h"
#include "scenario/io/reader.h"

namespace fogline {
namespace {

// A scenario, and the tree of JSON values from which it was read. Each place in this tree (Place)
// has the index of its source in `sources`.
struct Document {
  Scenario scenario;
  JsonValue root;
  std::vector<Source> sources;
};

// @throws ScenarioError
Document ReadDocument(std::string_view text, std::string_view name,
                      const std::vector<std::string>& overrides) {
  Document document;
  document.sources.push_back({.name = std::string(name), .text = text});
  for (const std::string& override_text : overrides) {
    document.sources.push_back(
        {.name = "--set " + Shown(override_text), .text = "", .has_lines = false});
  }
  DiagnosticList mistakes;
  std::optional<JsonValue> root = ParseJson(text, 0, mistakes);
  if (!root) mistakes.Throw(document.sources);
  document.root = *std::move(root);
  for (std::size_t i = 0; i < overrides.size(); ++i) {
    ApplyOverride(overrides[i], static_cast<std::uint32_t>(i + 1), document.root, mistakes);
  }
  document.scenario = ReadScenario(document.root, mistakes);
  if (!mistakes.empty()) mistakes.Throw(document.sources);
  return document;
}

}  // namespace

Scenario ParseScenario(std::string_view text, std::string_view name,
                       const std::vector<std::string>& overrides) {
  return ReadDocument(text, name, overrides).scenario;
}

Scenario LoadScenario(const std::filesystem::path& file,
                      const std::vector<std::string>& overrides) {
  const FileText read = ReadFile(file, kMaxFileBytes, ".json");
  if (!read.error.empty()) ThrowUnreadable(file.string(), read.error);
  Document document = ReadDocument(read.text, file.string(), overrides);
  const LeadSection& lead = document.scenario.lead;
  if (lead.profile == LeadProfile::kRecorded && lead.recorded.speeds_mps.empty()) {
    ResolveRecorded(file.parent_path(), document.root, document.sources, document.scenario);
  }
  if (lead.profile == LeadProfile::kSumo) {
    ResolveSumo(file.parent_path(), document.root, document.sources, document.scenario);
  }
  return std::move(document.scenario);
}

}  // namespace fogline
