// The file of a sweep: a CSV that grows row by row in a defined order, and beside it FILE.json,
// which says what the sweep is. A sweep that was killed goes on where its file ends.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/sweep/engine.h"
#include "tools/sweep/plan.h"

namespace fogline {

/// "FILE.json", what the sweep in FILE is.
std::filesystem::path DescriptionFile(const std::filesystem::path& csv);

class SweepFile {
 public:
  /// Opens the file of a shard: a new one, or one that the same sweep has left unfinished. Rows
  /// that are incomplete are cut off. With `force` what is there is replaced.
  /// @throws InputError if the file is there and is not of the same sweep, or cannot be written
  SweepFile(const std::filesystem::path& file, const SweepPlan& plan, const Shard& shard,
            bool force);

  /// First unit that is not in the file yet; the shard's end if it is complete.
  std::int64_t next_unit() const { return next_unit_; }

  /// Appends the rows of unit next_unit(). @throws std::runtime_error, such as when the disk is
  /// full
  void Append(const std::vector<SweepRow>& rows);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void Start();
  /// Counts whole units in an existing file and cuts off what follows.
  void Resume();
  void Write(const std::string& text);

  std::filesystem::path path_;
  const SweepPlan& plan_;
  std::int64_t next_unit_;
  std::string text_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Puts the complete files of all shards of a sweep together, in whatever order they are given.
/// @throws InputError if one is missing, double, incomplete or of another sweep
void MergeShards(const std::vector<std::filesystem::path>& shards,
                 const std::filesystem::path& merged, bool force);

}  // namespace fogline
