// Tables as CSV: one file for each channel, with a header line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/export/run_tables.h"

namespace fogline {

/// Files that WriteCsv() writes into a folder: CHANNEL.csv for each channel, and scenario.json.
std::vector<std::filesystem::path> CsvFiles(const std::filesystem::path& folder);

/// Writes them, and replaces none before all are written: files that were there stay as they are
/// when the disk is full. Columns have the names of fields, those of a list
/// "state.0", "state.1" and so on. Numbers have as many digits as bring back every bit.
/// @throws InputError if no file can be there; std::runtime_error when the disk is full
void WriteCsv(const RunTables& tables, const std::filesystem::path& folder);

}  // namespace fogline
