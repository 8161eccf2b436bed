#include "scenario/io/files/sumo_files.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "common/file.h"
#include "common/text.h"

namespace fogline {
namespace {

// A piece of at most this many bytes has at most kMaxTextLength characters.
constexpr std::size_t kMostBytes = kMaxTextLength;

/// Appends a line in pieces of at most kMostBytes bytes. @return false if the line has more than
/// kMostBytes bytes without a space at which it can be split
bool AppendLine(std::string_view line, std::vector<std::string>& lines) {
  while (line.size() > kMostBytes) {
    const std::size_t space = line.rfind(' ', kMostBytes);
    if (space == std::string_view::npos) return false;
    lines.emplace_back(line.substr(0, space));
    line.remove_prefix(space + 1);
  }
  lines.emplace_back(line);
  return true;
}

/// Reads the lines of a file. Replaces each tab with a space, which means the same in XML, and
/// removes carriage returns. Any other control character within a line is a mistake.
/// @return the mistake in the file; "" if the file has none
std::string ReadLines(const std::filesystem::path& file, std::vector<std::string>& lines) {
  FileText read = ReadFile(file, kMaxFileBytes, ".xml");
  if (!read.error.empty()) return read.error;
  if (!IsUtf8(read.text)) return "is no UTF-8";
  std::erase(read.text, '\r');
  std::ranges::replace(read.text, '\t', ' ');
  std::string_view rest = read.text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    if (HasControlCharacter(rest.substr(0, end))) return "has a control character";
    if (!AppendLine(rest.substr(0, end), lines)) {
      return fmt::format("has more than {} characters without a space", kMostBytes);
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (lines.size() <= static_cast<std::size_t>(kMaxSumoLines)) return "";
  return fmt::format("has {} lines; at most {} are allowed", lines.size(), kMaxSumoLines);
}

}  // namespace

void ResolveSumo(const std::filesystem::path& folder, const JsonValue& root,
                 const std::vector<Source>& sources, Scenario& scenario) {
  DiagnosticList mistakes;
  const auto resolve = [&](std::string_view pointer, const std::string& name,
                           std::vector<std::string>& lines) {
    if (name.empty() || !lines.empty()) return;
    const std::filesystem::path file = folder / name;
    const std::string error = ReadLines(file, lines);
    if (error.empty()) return;
    mistakes.Add(FindPlace(root, pointer), std::string(pointer), "sumo-file",
                 fmt::format("{} {}", Shown(file.string()), error));
  };
  SumoSection& sumo = scenario.lead.sumo;
  resolve("/lead/sumo/net_file", sumo.net_file, sumo.net);
  resolve("/lead/sumo/route_file", sumo.route_file, sumo.routes);
  if (!mistakes.empty()) mistakes.Throw(sources);
}

}  // namespace fogline
