// Writes tables as a MAT-file of level 5 (by libmatio), which MATLAB, Octave and scipy.io read.
#pragma once

#include <filesystem>

#include "tools/export/run_tables.h"

namespace fogline::exports {

/// Whether WriteMat() has written the file. Only the beginning of the file is checked.
bool IsMatExport(const std::filesystem::path& file);

/// Writes the complete file or nothing. Each channel is one struct, such as TRUTH, with one column
/// vector for each field. A field that is a list is a matrix with one row for each message. The
/// header is a struct within the struct (TRUTH.header.step). Values have the types of the fields:
/// int64, int32, int8 and double. A channel that lacks messages has the field `heard`, which is 0
/// in the row of a missing message. The values in such a row, except those of the header, are NaN
/// or 0. The variable `scenario` is the scenario's text, if it is known. Equal logs give equal
/// files.
/// @throws InputError if the file cannot be created, or a channel is larger than the format can
///     hold; std::runtime_error when the disk is full; Interrupted
void WriteMat(const RunTables& tables, const std::filesystem::path& file);

}  // namespace fogline::exports
