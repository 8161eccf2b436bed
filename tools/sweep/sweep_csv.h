// The file of a sweep: a CSV file that grows row by row in a defined order. Beside it are
// FILE.json, which describes the sweep, and FILE.sums with checksums of its rows. A killed sweep
// continues at the end of its file. A pipe or device gets only the rows, and a sweep into it cannot
// be continued.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/sweep/engine.h"
#include "tools/sweep/plan.h"

namespace fogline::sweep {

class SweepFile {
 public:
  /// Opens the file of a shard. The file is new, or the same sweep has written a part of it. An
  /// incomplete unit at the end of the file is cut off. With `force` the file of any sweep is
  /// replaced, but a file that is not of a sweep is never replaced.
  /// @throws InputError if the file is not of a sweep; if it is of another sweep and `force` is
  /// false; if one of its rows is not the row that this sweep writes; if another process is writing
  /// the file; if the file cannot be opened; or as RefuseForeignSideFiles(). std::runtime_error if
  /// a write fails
  SweepFile(const std::filesystem::path& file, const SweepPlan& plan, const Shard& shard,
            bool force);

  /// First unit that is not in the file yet; the shard's end if the file is complete.
  std::int64_t next_unit() const { return next_unit_; }

  /// Appends the rows of unit next_unit(). @throws std::runtime_error when the disk is full, or if
  /// the file has been removed; Interrupted if an interrupt comes while a write to a pipe waits for
  /// a reader
  void Append(const std::vector<SweepRow>& rows);

 private:
  /// A file; the destructor closes it.
  struct Handle {
    explicit Handle(std::filesystem::path name) : path(std::move(name)) {}
    ~Handle();
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    std::filesystem::path path;
    int fd = -1;
  };

  void Open();
  void OpenSums();
  /// Whether to start with an empty file. @throws InputError if the existing file must not be
  /// replaced
  bool IsToBeReplaced(const Shard& shard, bool force) const;
  static void Cut(std::int64_t size, const Handle& file);
  void Start(const Shard& shard);
  /// Checks the existing rows and cuts off the bytes after the last whole unit.
  void Resume(const Shard& shard);
  /// Writes the checksums of all existing rows.
  void SumRows();
  void RequireInPlace() const;
  void Write(std::string_view text, const Handle& file) const;

  const SweepPlan& plan_;
  std::int64_t next_unit_;
  std::string text_;
  Handle file_;
  Handle sums_;  // the checksums; not open for a pipe or device
};

}  // namespace fogline::sweep
