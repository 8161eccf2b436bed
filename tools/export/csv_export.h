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

/// Whether WriteCsv() could have written the file. Only the beginning of a file is checked. For
/// scenario.json, the other files of an export must be beside it.
bool IsCsvExport(const std::filesystem::path& file);

/// Writes CHANNEL.csv for each table, and then scenario.json, as AtomicFiles. So the folder never
/// has old and new versions of these files together, even if the process is killed. A folder with
/// the new scenario.json has all files of the log. Without a scenario there is no scenario.json. If
/// the log has no wall clock, WriteCsv() at the end removes the file of the wall clock that an
/// earlier export has left. If the log has no scenario, WriteCsv() removes an earlier scenario.json
/// in the same way. If the disk is full, the old files do not change.
///
/// Columns have the names of fields. The columns of a list are "state.0", "state.1" and so on.
/// Numbers have enough digits to restore every bit. If the log lacks a message, its row has values
/// only in the cells of the header.
/// @return the files
/// @throws InputError if a file cannot be created in the folder; std::runtime_error when the disk
/// is full; Interrupted
std::vector<std::filesystem::path> WriteCsv(const RunTables& tables,
                                            const std::filesystem::path& folder);

}  // namespace fogline::exports
