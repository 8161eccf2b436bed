#include "tools/sweep/merge.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <string>
#include <system_error>

#include <fmt/core.h>

#include "scenario/loader.h"
#include "tools/sweep/description.h"
#include "tools/sweep/whole_file.h"

namespace fogline {
namespace {

struct ShardFile {
  std::filesystem::path path;
  Description description;
};

/// The shards by number: all of one sweep, each once.
std::map<std::int64_t, ShardFile> Ordered(const std::vector<std::filesystem::path>& shards) {
  std::map<std::int64_t, ShardFile> ordered;
  std::int64_t count = 0;
  for (const std::filesystem::path& path : shards) {
    const ShardFile file{path, ReadDescription(path)};
    const Shard& shard = file.description.shard;
    if (count == 0) count = shard.count;
    if (!ordered.empty() && ordered.begin()->second.description.sweep != file.description.sweep) {
      throw InputError(fmt::format("{}: error: not of the same sweep as {}", path.string(),
                                   shards.front().string()));
    }
    if (shard.count != count) {
      throw InputError(fmt::format("{}: error: shard {} of {}, but {} is one of {}", path.string(),
                                   shard.index, shard.count, shards.front().string(), count));
    }
    const auto [place, is_new] = ordered.emplace(shard.index, file);
    if (!is_new) {
      throw InputError(fmt::format("{}: error: shard {} of {}, as {}", path.string(), shard.index,
                                   count, place->second.path.string()));
    }
  }
  for (std::int64_t index = 1; index <= count; ++index) {
    if (!ordered.contains(index)) {
      throw InputError(fmt::format("error: --merge: shard {} of {} is missing", index, count));
    }
  }
  return ordered;
}

/// Copies the rows of a shard. `header` is empty before the first one, which sets and writes it.
void Copy(const ShardFile& shard, std::string& header, WholeFile& out) {
  std::ifstream in(shard.path, std::ios::binary);
  std::string line;
  std::int64_t rows = -1;  // the header is none
  for (; std::getline(in, line) && !in.eof(); ++rows) {
    line += '\n';
    if (rows >= 0) {
      out.Write(line);
    } else if (header.empty()) {
      header = line;
      out.Write(header);
    } else if (line != header) {
      throw InputError(
          fmt::format("{}:1: error: other columns than the first shard's", shard.path.string()));
    }
  }
  if (rows != shard.description.rows || !line.empty()) {
    if (rows >= shard.description.rows) {
      throw InputError(fmt::format("{}: error: has more than its {} rows", shard.path.string(),
                                   shard.description.rows));
    }
    throw InputError(fmt::format("{}: error: has {} of {} rows; run its sweep again to finish it",
                                 shard.path.string(), std::max<std::int64_t>(0, rows),
                                 shard.description.rows));
  }
}

}  // namespace

std::int64_t MergeShards(const std::vector<std::filesystem::path>& shards,
                         const std::filesystem::path& merged, bool force) {
  if (std::filesystem::exists(merged) && !force) {
    throw InputError(
        fmt::format("{}: error: --out: the file exists; --force replaces it", merged.string()));
  }
  for (const std::filesystem::path& shard : shards) {
    std::error_code ignored;
    if (std::filesystem::equivalent(shard, merged, ignored)) {
      throw InputError(fmt::format("{}: error: --out: is one of the shards", merged.string()));
    }
  }
  const std::map<std::int64_t, ShardFile> ordered = Ordered(shards);
  Description whole = ordered.begin()->second.description;
  whole.shard = {.index = 1, .count = 1};
  whole.rows = whole.all_rows;

  RequireFolderOf(merged, "--out");
  WholeFile out(merged);
  std::string header;
  for (const auto& [index, shard] : ordered) Copy(shard, header, out);
  // At no moment is a file there with another one's description.
  std::filesystem::remove(merged);
  WriteDescription(merged, whole);
  out.Finish();
  return whole.rows;
}

}  // namespace fogline
