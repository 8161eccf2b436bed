// fogline export: writes a log as CSV or as a MAT-file, for programs that do not know LCM.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/cli/logs/log_reading.h"
#include "tools/export/csv_export.h"
#include "tools/export/mat_export.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct ExportArguments {
  explicit ExportArguments(CLI::App& verb) : reading(verb) {}

  cli::LogReading reading;
  std::filesystem::path log;
  std::filesystem::path out;
  bool force = false;
  bool json = false;
};

bool IsMat(const std::filesystem::path& out) { return out.extension() == ".mat"; }

/// Checks that the files may be written. Without --force none of these files may exist. With
/// --force an existing file must be an export. @throws InputError
void CheckFiles(const ExportArguments& arguments) {
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

int RunExport(const ExportArguments& arguments) {
  CheckFiles(arguments);
  WatchInterrupts();
  // The log is read first, so that no folder is made if the file is no log.
  log::ReadOptions options = arguments.reading.Options();
  options.needs_scenario = false;
  const exports::RunTables tables = exports::ReadRunTables(arguments.log, options);
  const std::vector<std::filesystem::path> files = Write(tables, arguments.out);
  const log::RunLog& run = tables.run;
  if (arguments.json) {
    nlohmann::ordered_json json{{"log", arguments.log.string()},
                                {"steps", run.steps},
                                {"complete", run.complete},
                                {"files", nlohmann::ordered_json::array()}};
    if (run.gaps.Any()) json["gaps"] = cli::GapsJson(run.gaps);
    for (const std::filesystem::path& file : files) json["files"].push_back(file.string());
    cli::PrintJson(json);
  } else {
    for (const std::filesystem::path& file : files) fmt::print("{}\n", PathText(file));
  }
  cli::SayAboutLog(arguments.log, run);
  return run.complete ? kDone : kCheckFailed;
}

}  // namespace

void AddExport(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("export", "Write a log as CSV files or as a MAT-file");
  const auto arguments = std::make_shared<ExportArguments>(*verb);
  verb->add_option("LOG", arguments->log, "Event log")->required();
  verb->add_option(
          "--out", arguments->out,
          "FILE.mat: one MAT-file of level 5. Else a folder: CHANNEL.csv for each channel, "
          "and scenario.json")
      ->required();
  verb->add_flag("--force", arguments->force, "Replace existing files of an export");
  verb->add_flag("--json", arguments->json, "Print the names of the files as JSON");
  cli::ShowExitCodes(*verb, {.check_failed = "the log is not complete", .interruptible = true});
  verb->footer(
      "Writes everything in the log, to the last bit, in the units of the messages (lcmtypes).\n"
      "The columns of a list are state.0, state.1 and so on; a matrix is written row by row.\n"
      "Time is header.utime, in microseconds. In a MAT-file each channel is a struct:\n"
      "TRUTH.host_gap_m has a row for each message. An incomplete log is written as far as it\n"
      "goes. A message that is missing has a row with empty cells; in a MAT-file the row has NaN\n"
      "and 0, and the field heard is 0. Without a scenario the channels are written alone.\n\n"
      "Examples:\n"
      "  fogline export logs/paper-1.lcm --out logs/paper-1\n"
      "  fogline export logs/paper-1.lcm --out logs/paper-1.mat\n"
      "  octave --eval 'load logs/paper-1.mat; plot(TRUTH.header.step, TRUTH.host_gap_m)'");
  verb->callback([&action, arguments] { action = [arguments] { return RunExport(*arguments); }; });
}

}  // namespace fogline
