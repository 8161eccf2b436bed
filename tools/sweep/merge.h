// Joins the files of a sweep's shards into the file that the unsharded sweep would have written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace fogline::sweep {

/// A merged file.
struct Merged {
  std::int64_t rows = 0;
  std::vector<std::filesystem::path> unchecked;  // shards with rows, but without checksums
};

/// Merges the complete files of all shards, given in any order. The merged file is written whole or
/// not at all.
/// @throws InputError if a shard is missing, is given twice, is incomplete or belongs to another
/// sweep; if `merged` exists and `force` is false; if `merged` exists and is not a sweep; or as
/// RefuseForeignSideFiles() does. std::runtime_error when the disk is full; Interrupted
Merged MergeShards(const std::vector<std::filesystem::path>& shards,
                   const std::filesystem::path& merged, bool force);

}  // namespace fogline::sweep
