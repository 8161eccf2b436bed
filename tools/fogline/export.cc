// fogline export: a log for programs that know nothing of LCM, as CSV or as a MAT-file.
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "scenario/loader.h"
#include "tools/export/csv_export.h"
#include "tools/export/mat_export.h"
#include "tools/fogline/arguments.h"
#include "tools/fogline/help.h"
#include "tools/fogline/verbs.h"
#include "tools/sweep/whole_file.h"

namespace fogline {
namespace {

struct ExportArguments {
  std::filesystem::path log;
  std::filesystem::path out;
  bool force = false;
  bool json = false;
};

bool IsMat(const std::filesystem::path& out) { return out.extension() == ".mat"; }

/// What will be written; nothing of it may be there without --force. @throws InputError
std::vector<std::filesystem::path> FilesOf(const ExportArguments& arguments) {
  const bool is_mat = IsMat(arguments.out);
  const std::vector<std::filesystem::path> files =
      is_mat ? std::vector{arguments.out} : CsvFiles(arguments.out);
  for (const std::filesystem::path& file : files) {
    if (arguments.force || !std::filesystem::exists(file)) continue;
    throw InputError(
        fmt::format("{}: error: --out: the file exists; --force replaces it", file.string()));
  }
  return files;
}

int RunExport(const ExportArguments& arguments) {
  const std::vector<std::filesystem::path> files = FilesOf(arguments);
  // Before anything is made: of a log that is none there shall be no folder.
  const RunTables tables = ReadRunTables(arguments.log);
  const bool is_mat = IsMat(arguments.out);
  is_mat ? RequireWritable(arguments.out, "--out") : RequireWritableFolder(arguments.out, "--out");
  is_mat ? WriteMat(tables, arguments.out) : WriteCsv(tables, arguments.out);
  if (arguments.json) {
    nlohmann::ordered_json json{{"log", arguments.log.string()},
                                {"steps", tables.steps},
                                {"complete", tables.complete},
                                {"files", nlohmann::ordered_json::array()}};
    for (const std::filesystem::path& file : files) json["files"].push_back(file.string());
    PrintJson(json.dump(2));
  } else {
    for (const std::filesystem::path& file : files) fmt::print("{}\n", file.string());
  }
  if (!tables.note.empty()) fmt::print(stderr, "{}: {}\n", arguments.log.string(), tables.note);
  return tables.complete ? kDone : kCheckFailed;
}

}  // namespace

void AddExport(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("export", "Write a log as CSV files or as a MAT-file");
  const auto arguments = std::make_shared<ExportArguments>();
  verb->add_option("LOG", arguments->log, "Event log")->required();
  verb->add_option(
          "--out", arguments->out,
          "FILE.mat: one MAT-file of level 5. Else a folder: CHANNEL.csv for each channel, "
          "and scenario.json")
      ->required();
  verb->add_flag("--force", arguments->force, "Replace files that exist");
  verb->add_flag("--json", arguments->json, "Print the names of the files as JSON");
  ShowExitCodes(*verb, {.check_failed = "the log is not complete"});
  verb->footer(
      "Everything that the log has, to the last bit, in the units of the messages (lcmtypes); the\n"
      "columns of a list are state.0, state.1 and so on, a matrix row by row. Time is "
      "header.utime,\n"
      "in microseconds. In a MAT-file each channel is a struct: TRUTH.host_gap_m has a row for "
      "each\n"
      "message. Of a log that is not complete, all that it has is written.\n\n"
      "Examples:\n"
      "  fogline export logs/paper-1.lcm --out paper-1\n"
      "  fogline export logs/paper-1.lcm --out paper-1.mat\n"
      "  octave --eval 'load paper-1.mat; plot(double(TRUTH.header.utime)/1e6, TRUTH.host_gap_m)'");
  verb->callback([&action, arguments] { action = [arguments] { return RunExport(*arguments); }; });
}

}  // namespace fogline
