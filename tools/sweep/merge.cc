#include "tools/sweep/merge.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/core.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/file.h"
#include "common/interrupt.h"
#include "common/text.h"
#include "tools/sweep/description.h"
#include "tools/sweep/row_sums.h"
#include "tools/sweep/side_files.h"

namespace fogline::sweep {
namespace {

struct ShardFile {
  std::filesystem::path path;
  Description description;
};

/// The shards by number. Checks that all shards are of one sweep, and that each number occurs once.
std::map<std::int64_t, ShardFile> Ordered(const std::vector<std::filesystem::path>& shards) {
  std::map<std::int64_t, ShardFile> ordered;
  std::int64_t count = 0;
  for (const std::filesystem::path& path : shards) {
    if (const std::string why = WhyNoRegularFile(path); !why.empty()) {
      throw InputError(
          fmt::format("{}: error: not the result of a sweep: {}", PathText(path), why));
    }
    const ShardFile file{path, ReadDescription(path)};
    const Shard& shard = file.description.shard;
    if (count == 0) count = shard.count;
    if (!ordered.empty() && ordered.begin()->second.description.sweep != file.description.sweep) {
      throw InputError(fmt::format("{}: error: not of the same sweep as {}", PathText(path),
                                   PathText(shards.front())));
    }
    if (shard.count != count) {
      throw InputError(fmt::format("{}: error: shard {} of {}, but {} is a shard of {}",
                                   PathText(path), shard.index, shard.count,
                                   PathText(shards.front()), count));
    }
    const auto [place, is_new] = ordered.emplace(shard.index, file);
    if (!is_new) {
      throw InputError(fmt::format("{}: error: shard {} of {}, the same as {}", PathText(path),
                                   shard.index, count, PathText(place->second.path)));
    }
  }
  for (std::int64_t index = 1; index <= count; ++index) {
    if (!ordered.contains(index)) {
      throw InputError(fmt::format("error: --merge: shard {} of {} is missing", index, count));
    }
  }
  return ordered;
}

/// Checks the line of a row with its checksum, if the shard has checksums. @throws InputError if
/// the checksum differs, or if the row has no checksum although earlier rows have one
void RequireSum(RowChecker& checker, const std::string& line, const std::filesystem::path& shard,
                std::int64_t row) {
  if (!checker.has_sums()) return;
  const RowChecker::Verdict verdict = checker.Check(line);
  if (verdict == RowChecker::Verdict::kSame) return;
  throw InputError(
      fmt::format("{}:{}: error: {}", PathText(shard), row + 2,
                  verdict == RowChecker::Verdict::kOther
                      ? "the line differs from the one that its sweep wrote there"
                      : "the row has no checksum; run its sweep again to compute the row again"));
}

/// Copies the rows of a shard, and also the header if the shard is the first one.
/// @return true if the shard has checksums, or has no rows
bool Copy(const ShardFile& shard, std::string& header, AtomicFile& out, AtomicFile* sums) {
  std::ifstream in(shard.path, std::ios::binary);
  RowChecker checker(shard.path);
  std::string line;
  std::int64_t rows = -1;  // -1 is the header
  for (; std::getline(in, line) && !in.eof(); ++rows) {
    if (WasInterrupted()) throw Interrupted("interrupted; nothing is merged");
    if (rows >= 0) RequireSum(checker, line, shard.path, rows);
    if (rows >= 0 && sums != nullptr) sums->Write(SumLine(line));
    line += '\n';
    if (rows >= 0) {
      out.Write(line);
    } else if (header.empty()) {
      header = line;
      out.Write(header);
    } else if (line != header) {
      throw InputError(fmt::format("{}:1: error: the columns differ from those of the first shard",
                                   PathText(shard.path)));
    }
  }
  if (rows != shard.description.rows || !line.empty()) {
    if (rows >= shard.description.rows) {
      throw InputError(fmt::format("{}: error: has more than its {} rows", PathText(shard.path),
                                   shard.description.rows));
    }
    throw InputError(fmt::format("{}: error: has {} of {} rows; run its sweep again to finish it",
                                 PathText(shard.path), std::max<std::int64_t>(0, rows),
                                 shard.description.rows));
  }
  return checker.has_sums() || rows == 0;
}

}  // namespace

Merged MergeShards(const std::vector<std::filesystem::path>& shards,
                   const std::filesystem::path& merged, bool force) {
  RefuseToReplace(merged, "--out", force, "sweep", IsSweep);
  if (IsReplaceable(merged)) RefuseForeignSideFiles(merged);
  for (const std::filesystem::path& shard : shards) {
    std::error_code ignored;
    if (std::filesystem::equivalent(shard, merged, ignored)) {
      throw InputError(fmt::format("{}: error: --out: is one of the shards", PathText(merged)));
    }
  }
  const std::map<std::int64_t, ShardFile> ordered = Ordered(shards);
  Description whole = ordered.begin()->second.description;
  whole.shard = {.index = 1, .count = 1};
  whole.rows = whole.all_rows;

  const bool replaceable = IsReplaceable(merged);
  if (replaceable) RequireFolderOf(merged, "--out");
  AtomicFile out(merged);
  std::optional<AtomicFile> sums;
  if (replaceable) sums.emplace(SumsFile(merged));
  std::string header;
  Merged result{.rows = whole.rows, .unchecked = {}};
  for (const auto& [index, shard] : ordered) {
    const bool checked = Copy(shard, header, out, sums ? &*sums : nullptr);
    if (!checked) result.unchecked.push_back(shard.path);
  }
  if (replaceable) {
    // The old file is removed first, so that the old file is never beside the description of the
    // new file.
    out.RemoveOld();
    WriteDescription(merged, whole);
    sums->Finish();
  }
  out.Finish();
  return result;
}

}  // namespace fogline::sweep
