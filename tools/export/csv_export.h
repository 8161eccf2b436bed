// Tables as CSV: one file for each channel, with a header line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/export/run_tables.h"

namespace fogline::exports {

/// Files that WriteCsv() writes into a folder: CHANNEL.csv for each channel, and scenario.json.
std::vector<std::filesystem::path> CsvFiles(const std::filesystem::path& folder);

/// Whether WriteCsv() could have written the file, judged by its beginning.
bool IsCsvExport(const std::filesystem::path& file);

/// Writes these files. No old file is replaced before all new ones are on the disk, so the old
/// files stay as they are when the disk is full. Then all old files are removed before the first
/// new one gets its name. scenario.json gets its name last. So, even if the process is killed, no
/// folder has files of two logs, and a folder with scenario.json has all files of one log. Columns
/// have the names of fields; those of a list are "state.0", "state.1" and so on. Numbers have
/// enough digits to restore every bit.
/// @throws InputError if a file cannot be created there; std::runtime_error when the disk is full;
/// Interrupted
void WriteCsv(const RunTables& tables, const std::filesystem::path& folder);

}  // namespace fogline::exports
