// fogline export: writes a log as CSV, MAT-file or MCAP file, for programs that do not know LCM.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "common/interrupt.h"
#include "common/process/console.h"
#include "common/text.h"
#include "tools/cli/arguments.h"
#include "tools/cli/help.h"
#include "tools/export/csv_export.h"
#include "tools/export/mat_export.h"
#include "tools/export/mcap/mcap_export.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

struct ExportArguments {
  std::filesystem::path log;
  std::filesystem::path out;
  std::filesystem::path mcap;
  bool force = false;
  bool json = false;
};

bool IsMat(const std::filesystem::path& out) { return out.extension() == ".mat"; }

/// The files to be written. Without --force none of these files may exist. With --force an existing
/// file must be an export. @throws InputError
std::vector<std::filesystem::path> FilesOf(const ExportArguments& arguments) {
  const bool is_mat = IsMat(arguments.out);
  const std::vector<std::filesystem::path> files =
      is_mat ? std::vector{arguments.out} : exports::CsvFiles(arguments.out);
  for (const std::filesystem::path& file : files) {
    RefuseToReplace(file, "--out", arguments.force, "export",
                    is_mat ? exports::IsMatExport : exports::IsCsvExport);
  }
  return files;
}

/// What an export has of the log.
struct Exported {
  std::vector<std::filesystem::path> files;
  std::int64_t steps = 0;
  bool complete = false;
  std::string note;
};

Exported ExportTables(const ExportArguments& arguments) {
  const std::vector<std::filesystem::path> files = FilesOf(arguments);
  // The log is read first, so that no folder is made if the file is no log.
  const exports::RunTables tables = exports::ReadRunTables(arguments.log);
  const bool is_mat = IsMat(arguments.out);
  std::optional<OutputFolder> folder;
  is_mat ? RequireWritable(arguments.out, "--out") : void(folder.emplace(arguments.out, "--out"));
  is_mat ? exports::WriteMat(tables, arguments.out) : exports::WriteCsv(tables, arguments.out);
  return {.files = files, .steps = tables.steps, .complete = tables.complete, .note = tables.note};
}

Exported ExportMcap(const ExportArguments& arguments) {
  RefuseToReplace(arguments.mcap, "--mcap", arguments.force, "export", mcap::IsMcapExport);
  RequireWritable(arguments.mcap, "--mcap");
  cli::RefuseJsonBeside(arguments.mcap, "--mcap", arguments.json);
  const mcap::Exported written = mcap::WriteMcap(arguments.log, arguments.mcap);
  return {.files = {arguments.mcap},
          .steps = written.steps,
          .complete = written.complete,
          .note = written.note};
}

int RunExport(const ExportArguments& arguments) {
  WatchInterrupts();
  const Exported exported =
      arguments.mcap.empty() ? ExportTables(arguments) : ExportMcap(arguments);
  if (arguments.json) {
    nlohmann::ordered_json json{{"log", arguments.log.string()},
                                {"steps", exported.steps},
                                {"complete", exported.complete},
                                {"files", nlohmann::ordered_json::array()}};
    for (const std::filesystem::path& file : exported.files) json["files"].push_back(file.string());
    cli::PrintJson(json);
  } else {
    for (const std::filesystem::path& file : exported.files) {
      cli::PrintBeside(arguments.mcap, fmt::format("{}\n", PathText(file)));
    }
  }
  if (!exported.note.empty()) {
    Complain(fmt::format("{}: {}", PathText(arguments.log), exported.note));
  }
  return exported.complete ? kDone : kCheckFailed;
}

}  // namespace

void AddExport(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("export", "Write a log as CSV, MAT or MCAP files");
  const auto arguments = std::make_shared<ExportArguments>();
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
      "goes.\n\n"
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
