// Description of a sweep file: grid, seeds, scenario, and the shard (the part of the sweep) whose
// rows the file has. The description is in "FILE.json" beside the sweep file. A sweep recognises
// its own file by the description, and a merge recognises the shards of one sweep.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tools/sweep/plan.h"

namespace fogline::sweep {

struct Description {
  std::string sweep;          // everything except the shard, as JSON; equal sweeps have equal text
  Shard shard;                // the shard that the file has
  std::int64_t rows = 0;      // number of rows in the shard's complete file
  std::int64_t all_rows = 0;  // number of rows of the whole sweep

  bool operator==(const Description&) const = default;
};

Description Describe(const SweepPlan& plan, const Shard& shard);

/// The path "FILE.json".
std::filesystem::path DescriptionFile(const std::filesystem::path& csv);

/// Whether a file is the file of a sweep: whether a readable description is beside the file.
bool IsSweep(const std::filesystem::path& csv);

/// The description beside a sweep's file.
/// @throws InputError if there is no description, or it is damaged
Description ReadDescription(const std::filesystem::path& csv);

/// Writes the description beside a sweep's file, completely or not at all.
/// @throws InputError if the description's file cannot be created; std::runtime_error when the disk
/// is full
void WriteDescription(const std::filesystem::path& csv, const Description& description);

}  // namespace fogline::sweep
