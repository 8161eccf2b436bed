// The files that a sweep keeps beside its CSV file.
#pragma once

#include <filesystem>

namespace fogline::sweep {

/// Refuses a sweep whose FILE.json or FILE.sums would replace a file that is not from a sweep. An
/// example: "--out scenario/paper" must not replace "scenario/paper.json".
/// @throws InputError "FILE.json: error: --out: the file is no sweep description and is not
/// replaced, even with --force", or a similar text for FILE.sums
void RefuseForeignSideFiles(const std::filesystem::path& csv);

}  // namespace fogline::sweep
