// Writes tables as CSV: one file for each channel, with a header line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/export/run_tables.h"

namespace fogline::exports {

/// Files that WriteCsv() writes into a folder: CHANNEL.csv for each channel, and scenario.json.
std::vector<std::filesystem::path> CsvFiles(const std::filesystem::path& folder);
/// The files that WriteCsv() writes into a folder only for some logs. There is one such file: the
/// wall clock of the steps. WriteCsv() writes it if the log contains the wall clock.
std::vector<std::filesystem::path> CsvFilesOfSomeLogs(const std::filesystem::path& folder);

/// Whether WriteCsv() could have written the file, judged by its beginning.
bool IsCsvExport(const std::filesystem::path& file);

/// Writes CHANNEL.csv for each table, and then scenario.json, as AtomicFiles. So the folder never
/// has old and new versions of these files together, even if the process is killed. A folder with
/// the new scenario.json has all files of the log. If the log has no wall clock, or no scenario,
/// WriteCsv() at the end removes the file that an earlier export has left. If the disk is full, the
/// old files do not change. Columns have the names of fields. The columns of a list are "state.0",
/// "state.1" and so on. Numbers have enough digits to restore every bit. A row of a message that
/// the log lacks has only the cells of the header. Without a scenario there is no scenario.json.
/// @return the files
/// @throws InputError if a file cannot be created in the folder; std::runtime_error when the disk
/// is full; Interrupted
std::vector<std::filesystem::path> WriteCsv(const RunTables& tables,
                                            const std::filesystem::path& folder);

}  // namespace fogline::exports
