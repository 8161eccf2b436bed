// The file of a log while its run writes and reads it.
#pragma once

#include <filesystem>
#include <memory>

#include "common/file_lock.h"

namespace fogline::log {

/// Keeps a log locked against other runs until the end of this object. At this end a log without a
/// step is removed, because its run never began. If the log has replaced an older one, that one
/// comes back.
class LogOfRun {
 public:
  /// A run without a log.
  LogOfRun() = default;
  /// @throws InputError if another run is writing it, or if it cannot be written
  explicit LogOfRun(const std::filesystem::path& log);
  /// @param lock on the file
  LogOfRun(std::filesystem::path log, std::unique_ptr<FileLock> lock);
  /// Puts an empty log in the place of an older one, which is kept beside it as ".fogline-*" until
  /// the end of this object. Where the file system cannot exchange two files, the older log is
  /// written over.
  /// @param lock on the older log
  static LogOfRun InPlaceOf(const std::filesystem::path& log, std::unique_ptr<FileLock> lock);
  ~LogOfRun();
  LogOfRun(LogOfRun&&) = default;
  LogOfRun(const LogOfRun&) = delete;
  LogOfRun& operator=(const LogOfRun&) = delete;

  /// "" for a run without a log.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::unique_ptr<FileLock> lock_;
  std::filesystem::path older_;  // the older log; "" if there was none
};

/// Whether a log contains more than a scenario and a seal. @throws InputError if it is no event log
bool HasSteps(const std::filesystem::path& log);

}  // namespace fogline::log
