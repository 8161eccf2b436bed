// Joins the files of a sweep's shards into the file that the unsharded sweep would have written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace fogline::sweep {

/// Merges the complete files of all shards, given in any order. The merged file is written whole or
/// not at all. @return the number of its rows
/// @throws InputError if a shard is missing, double, incomplete or of another sweep, or if `merged`
///     exists and there is no `force`, or is no sweep; as RefuseForeignSideFiles();
///     std::runtime_error when the disk is full; Interrupted
std::int64_t MergeShards(const std::vector<std::filesystem::path>& shards,
                         const std::filesystem::path& merged, bool force);

}  // namespace fogline::sweep
