// The file of a sweep: a CSV that grows row by row in a defined order, and beside it FILE.json,
// which says what the sweep is. A sweep that was killed goes on where its file ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/sweep/engine.h"
#include "tools/sweep/plan.h"

namespace fogline {

class SweepFile {
 public:
  /// Opens the file of a shard: a new one, or one that the same sweep has left unfinished. What is
  /// incomplete at its end is cut off. With `force` what is there is replaced.
  /// @throws InputError if the file is there and is not of the same sweep, if somebody is writing
  ///     it, or if it cannot be written; std::runtime_error when the disk is full
  SweepFile(const std::filesystem::path& file, const SweepPlan& plan, const Shard& shard,
            bool force);

  /// First unit that is not in the file yet; the shard's end if it is complete.
  std::int64_t next_unit() const { return next_unit_; }

  /// Appends the rows of unit next_unit(). @throws std::runtime_error when the disk is full
  void Append(const std::vector<SweepRow>& rows);

 private:
  /// An open file, closed at the end.
  struct Handle {
    Handle() = default;
    ~Handle();
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    int fd = -1;
  };

  void Open();
  void Cut(std::int64_t size);
  void Start(const Shard& shard);
  /// Checks the rows that are there, cuts off what follows the last whole unit.
  void Resume(const Shard& shard);
  void Write(const std::string& text);

  std::filesystem::path path_;
  const SweepPlan& plan_;
  std::int64_t next_unit_;
  std::string text_;
  Handle file_;
};

}  // namespace fogline
