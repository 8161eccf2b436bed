// Tables as CSV: one file for each channel, with a header line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/export/run_tables.h"

namespace fogline {

/// Files that WriteCsv() writes into a folder: CHANNEL.csv for each channel, and scenario.json.
std::vector<std::filesystem::path> CsvFiles(const std::filesystem::path& folder);

/// Whether a file is one that WriteCsv() could have written, by its beginning.
bool IsCsvExport(const std::filesystem::path& file);

/// Writes them, and replaces none before all are on the disk: files that were there stay as they
/// are when it is full. Then all old ones are removed before the first new one has its name, and
/// scenario.json has it last: whenever the process is killed, no folder has files of two logs, and
/// one with scenario.json has all of one. Columns have the names of fields, those of a list
/// "state.0", "state.1" and so on. Numbers have as many digits as bring back every bit.
/// @throws InputError if no file can be there; std::runtime_error when the disk is full;
/// Interrupted
void WriteCsv(const RunTables& tables, const std::filesystem::path& folder);

}  // namespace fogline
