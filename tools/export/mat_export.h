// Tables as a MAT-file of level 5, which MATLAB, Octave and scipy.io read (by libmatio).
#pragma once

#include <filesystem>

#include "tools/export/run_tables.h"

namespace fogline {

/// Whether a file is one that WriteMat() has written, by its beginning.
bool IsMatExport(const std::filesystem::path& file);

/// Writes the file, whole or not at all: for each channel one struct, such as TRUTH, with a column
/// for each field, and a matrix with a row for each message where the field is a list; the header
/// is a struct within it (TRUTH.header.step). Types are those of the fields: int64, int32, int8 and
/// double. The variable `scenario` is the scenario's text. Equal logs give equal files.
/// @throws InputError if no file can be there, or a channel is larger than the format can hold;
///     std::runtime_error when the disk is full; Interrupted
void WriteMat(const RunTables& tables, const std::filesystem::path& file);

}  // namespace fogline
