// What a sweep file holds, said in "FILE.json" beside it: grid, seeds, scenario, and which shard of
// them. By it a sweep recognises its own file, and shards that belong together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tools/sweep/plan.h"

namespace fogline {

struct Description {
  std::string sweep;          // all but the shard, as JSON; equal sweeps have equal text
  Shard shard;                // of that sweep
  std::int64_t rows = 0;      // of the shard's complete file
  std::int64_t all_rows = 0;  // of the whole sweep

  bool operator==(const Description&) const = default;
};

Description Describe(const SweepPlan& plan, const Shard& shard);

/// "FILE.json".
std::filesystem::path DescriptionFile(const std::filesystem::path& csv);

/// Whether a file is that of a sweep: there is a description beside it.
bool IsSweep(const std::filesystem::path& csv);

/// The description beside a sweep's file.
/// @throws InputError if there is none, or it is damaged
Description ReadDescription(const std::filesystem::path& csv);

/// Puts the description beside a sweep's file, whole or not at all.
/// @throws InputError if it cannot be there, std::runtime_error when the disk is full
void WriteDescription(const std::filesystem::path& csv, const Description& description);

}  // namespace fogline
