// fogline export: writes a log as CSV, MAT-file or MCAP file, for programs that do not know LCM.
#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/text.h"
#include "services/log/run_log.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/log_reading.h"
#include "tools/export/csv_export.h"
#include "tools/export/mat_export.h"
#include "tools/export/mcap/mcap_export.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct ExportArguments {
  explicit ExportArguments(CLI::App& verb) : reading(verb) {}

  cli::LogReading reading;
  std::filesystem::path log;
  std::filesystem::path out;
  std::filesystem::path mcap;
  bool force = false;
  bool json = false;
};

/// Whether the file has this extension. Upper and lower case count as equal.
/// @param extension in lower case, such as ".mat"
bool HasExtension(const std::filesystem::path& out, std::string_view extension) {
  return std::ranges::equal(out.extension().native(), extension, {},
                            [](unsigned char letter) { return std::tolower(letter); });
}

bool IsMat(const std::filesystem::path& out) { return HasExtension(out, ".mat"); }

// A name with one of these extensions is a mistake, because an export never writes such a file, and
// a folder hardly has such a name.
constexpr std::array<std::string_view, 9> kNoFolders{".csv",  ".tsv", ".txt",  ".json",   ".xls",
                                                     ".xlsx", ".h5",  ".hdf5", ".parquet"};

/// @throws InputError if the name is that of a file that `--out` does not write
void CheckExtension(const std::filesystem::path& out) {
  if (HasExtension(out, ".mcap")) {
    throw InputError(
        fmt::format("{}: error: --out: an MCAP file is written with --mcap", PathText(out)));
  }
  const auto has = [&out](std::string_view extension) { return HasExtension(out, extension); };
  if (std::ranges::any_of(kNoFolders, has)) {
    throw InputError(fmt::format("{}: error: --out: neither FILE.mat nor a folder for CSV files",
                                 PathText(out)));
  }
}

/// Checks that the files may be written. Without --force none of these files may exist. With
/// --force an existing file must be an export. @throws InputError
void CheckFiles(const ExportArguments& arguments) {
  CheckExtension(arguments.out);
  const bool is_mat = IsMat(arguments.out);
  std::vector<std::filesystem::path> files{arguments.out};
  if (!is_mat) {
    files = exports::CsvFiles(arguments.out);
    for (auto& file : exports::CsvFilesOfSomeLogs(arguments.out)) files.push_back(std::move(file));
  }
  for (const std::filesystem::path& file : files) {
    RefuseToReplace(file, "--out", arguments.force, "export",
                    is_mat ? exports::IsMatExport : exports::IsCsvExport);
  }
}

/// @return the files that were written
std::vector<std::filesystem::path> Write(const exports::RunTables& tables,
                                         const std::filesystem::path& out) {
  if (!IsMat(out)) {
    const OutputFolder folder(out, "--out");
    return exports::WriteCsv(tables, out);
  }
  RequireWritable(out, "--out");
  exports::WriteMat(tables, out);
  return {out};
}

/// The files that an export has written, and the run in the log.
struct Exported {
  std::vector<std::filesystem::path> files;
  log::RunLog run;
};

Exported ExportTables(const ExportArguments& arguments, const log::ReadOptions& options) {
  CheckFiles(arguments);
  // The log is read first, so that no folder is made if the file is not a log.
  exports::RunTables tables = exports::ReadRunTables(arguments.log, options);
  std::vector<std::filesystem::path> files = Write(tables, arguments.out);
  return {.files = std::move(files), .run = std::move(tables.run)};
}

Exported ExportMcap(const ExportArguments& arguments, const log::ReadOptions& options) {
  RefuseToReplace(arguments.mcap, "--mcap", arguments.force, "export", mcap::IsMcapExport);
  RequireWritable(arguments.mcap, "--mcap");
  cli::RefuseJsonBeside(arguments.mcap, "--mcap", arguments.json);
  return {.files = {arguments.mcap},
          .run = mcap::WriteMcap(arguments.log, options, arguments.mcap)};
}

int RunExport(const ExportArguments& arguments) {
  WatchInterrupts();
  log::ReadOptions options = arguments.reading.Options();
  options.needs_scenario = false;
  const Exported exported =
      arguments.mcap.empty() ? ExportTables(arguments, options) : ExportMcap(arguments, options);
  if (arguments.json) {
    nlohmann::ordered_json json{{"log", arguments.log.string()},
                                {"steps", exported.run.steps},
                                {"complete", exported.run.complete},
                                {"files", nlohmann::ordered_json::array()}};
    if (exported.run.gaps.Any()) json["gaps"] = cli::GapsJson(exported.run.gaps);
    for (const std::filesystem::path& file : exported.files) json["files"].push_back(file.string());
    cli::PrintJson(json);
  } else {
    for (const std::filesystem::path& file : exported.files) {
      cli::PrintBeside(arguments.mcap, fmt::format("{}\n", PathText(file)));
    }
  }
  cli::SayAboutLog(arguments.log, exported.run);
  return exported.run.complete ? kDone : kCheckFailed;
}

}  // namespace

void AddExport(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("export", "Write a log as CSV, MAT or MCAP files");
  const auto arguments = std::make_shared<ExportArguments>(*verb);
  verb->add_option("LOG", arguments->log, "Event log")->required();
  auto* out = verb->add_option(
      "--out", arguments->out,
      "FILE.mat: one MAT-file of level 5. Else a folder: CHANNEL.csv for each channel, and "
      "scenario.json");
  verb->add_option("--mcap", arguments->mcap,
                   "In place of --out: one MCAP file, for Foxglove, Lichtblick, PlotJuggler, rerun")
      ->excludes(out);
  verb->add_flag("--force", arguments->force, "Replace existing files of an export");
  verb->add_flag("--json", arguments->json, "Print the names of the files as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "the log is not complete", .interruptible = true});
  verb->footer(
      "Writes everything in the log, to the last bit, in the units of the messages (lcmtypes).\n"
      "The columns of a list are state.0, state.1 and so on; a matrix is written row by row.\n"
      "Time is header.utime, in microseconds. In a MAT-file each channel is a struct:\n"
      "TRUTH.host_gap_m has a row for each message. An incomplete log is written as far as it\n"
      "goes. A message that is missing has a row with empty cells; in a MAT-file the row has NaN\n"
      "and 0, and its field heard is 0. In real time a step may have no message, and then it has\n"
      "no row: join channels by header.step. If the log has no scenario, only the channels are\n"
      "written.\n\n"
      "Examples:\n"
      "  fogline export logs/paper-1.lcm --out logs/paper-1\n"
      "  fogline export logs/paper-1.lcm --out logs/paper-1.mat\n"
      "  fogline export logs/paper-1.lcm --mcap logs/paper-1.mcap\n"
      "  octave --eval 'load logs/paper-1.mat; plot(TRUTH.header.step, TRUTH.host_gap_m)'");
  verb->callback([&action, arguments] {
    if (arguments->out.empty() && arguments->mcap.empty()) {
      throw CLI::RequiredError("--out or --mcap");
    }
    action = [arguments] { return RunExport(*arguments); };
  });
}

}  // namespace fogline
