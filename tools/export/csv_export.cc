#include "tools/export/csv_export.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "common/atomic_file.h"
#include "common/interrupt.h"
#include "services/graph.h"
#include "services/log/wall_clock.h"

namespace fogline::exports {
namespace {

constexpr std::string_view kScenarioFile = "scenario.json";
// The text is written in pieces of about this size, to save memory.
constexpr std::size_t kPieceBytes = 1 << 16;

std::filesystem::path FileOf(std::string_view channel, const std::filesystem::path& folder) {
  return folder / fmt::format("{}.csv", channel);
}

std::string HeaderLine(const ChannelTable& table) {
  std::string line;
  for (const FieldTable& field : table.fields) {
    for (std::size_t i = 0; i < field.width; ++i) {
      if (!line.empty()) line += ',';
      line += field.is_list ? fmt::format("{}.{}", field.name, i) : field.name;
    }
  }
  return line + '\n';
}

void AppendRow(const ChannelTable& table, std::size_t row, std::string& text) {
  const bool is_gap = table.IsGap(row);
  bool first = true;
  for (const FieldTable& field : table.fields) {
    std::visit(
        [&](const auto& values) {
          for (std::size_t i = row * field.width; i < (row + 1) * field.width; ++i) {
            if (!first) text += ',';
            first = false;
            if (is_gap && !IsOfHeader(field)) continue;  // an empty cell
            fmt::format_to(std::back_inserter(text), "{}", values[i]);
          }
        },
        field.values);
  }
  text += '\n';
}

void WriteChannel(const ChannelTable& table, AtomicFile& file) {
  std::string text = HeaderLine(table);
  for (std::size_t row = 0; row < table.messages; ++row) {
    AppendRow(table, row, text);
    if (text.size() < kPieceBytes) continue;
    if (WasInterrupted()) throw Interrupted("interrupted; no file was written");
    file.Write(text);
    text.clear();
  }
  file.Write(text);
}

bool BeginsWith(const std::filesystem::path& file, std::string_view text) {
  std::ifstream in(file, std::ios::binary);
  std::string head(text.size(), '\0');
  in.read(head.data(), std::ssize(head));
  return in.gcount() == std::ssize(text) && head == text;
}

/// Whether an export of a channel may replace `file`. This is true for a pipe, a device, and an
/// older export. An export begins with the columns of the messages' header.
bool IsChannel(const std::filesystem::path& file) {
  std::error_code ignored;
  return !IsReplaceable(file) || (std::filesystem::is_regular_file(file, ignored) &&
                                  BeginsWith(file, "header.run_id,header.step,"));
}

}  // namespace

std::vector<std::filesystem::path> CsvFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const ChannelInfo& channel : kChannels) {
    if (channel.pace == Pace::kStep) files.push_back(FileOf(channel.name, folder));
  }
  files.push_back(folder / kScenarioFile);
  return files;
}

bool IsCsvExport(const std::filesystem::path& file) {
  if (file.filename() != kScenarioFile) return IsChannel(file);
  // A scenario that is not part of an export may begin with this text, too. So the files beside
  // scenario.json must also be exports.
  if (!BeginsWith(file, "{\n  \"version\": ")) return false;
  const std::vector<std::filesystem::path> files = CsvFiles(file.parent_path());
  return std::all_of(files.begin(), files.end() - 1, IsChannel);
}

std::vector<std::filesystem::path> CsvFilesOfSomeLogs(const std::filesystem::path& folder) {
  return {FileOf(log::kWallClockChannel, folder)};
}

std::vector<std::filesystem::path> WriteCsv(const RunTables& tables,
                                            const std::filesystem::path& folder) {
  AtomicFiles files;
  std::vector<std::filesystem::path> written;
  const auto add = [&](const std::filesystem::path& file) -> AtomicFile& {
    written.push_back(file);
    return files.Add(file);
  };
  for (const ChannelTable& table : tables.channels) {
    WriteChannel(table, add(FileOf(table.name, folder)));
  }
  const bool has_scenario = !tables.scenario.empty();
  if (has_scenario) add(folder / kScenarioFile).Write(tables.scenario + '\n');
  files.Finish();
  // A file that was not written in this call is from an older export of another log, so it is
  // removed.
  std::vector<std::filesystem::path> others = CsvFilesOfSomeLogs(folder);
  others.push_back(folder / kScenarioFile);
  for (const std::filesystem::path& file : others) {
    std::error_code ignored;
    if (std::ranges::find(written, file) == written.end()) std::filesystem::remove(file, ignored);
  }
  return written;
}

}  // namespace fogline::exports
