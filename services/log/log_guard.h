// The file of a log during the run that writes it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "common/clock.h"
#include "common/file_lock.h"

namespace fogline::log {

/// Locks a log against other runs for the lifetime of this object. The destructor removes a log
/// without a step, because its run never began. If this log has replaced an older log, the
/// destructor restores the older log.
class LogGuard {
 public:
  /// An object for a run without a log.
  LogGuard() = default;
  /// @throws InputError if another run is writing the log, or if the log cannot be written
  explicit LogGuard(const std::filesystem::path& log);
  /// @param lock the lock on the file
  LogGuard(std::filesystem::path log, std::unique_ptr<FileLock> lock);
  /// Puts an empty log in the place of an older log. The older log stays in the same folder as
  /// ".fogline-older-NAME" until RemoveOlder() or the end of this object. If the file system cannot
  /// exchange two files, or cannot make a file of this name, the run overwrites the older log.
  /// @param lock the lock on the older log
  static LogGuard InPlaceOf(const std::filesystem::path& log, std::unique_ptr<FileLock> lock);
  ~LogGuard();
  LogGuard(LogGuard&&) = default;
  LogGuard(const LogGuard&) = delete;
  LogGuard& operator=(const LogGuard&) = delete;

  /// Removes the older log. Call RemoveOlder() when the log has its first step. After that, a
  /// killed run leaves one log and no other file. Later calls have no effect.
  void RemoveOlder();

  /// "" for a run without a log.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::unique_ptr<FileLock> lock_;
  std::filesystem::path older_;  // the older log; "" if there was no older log
};

/// Looks for the older log that a killed run has left beside `log`. If that run has written no step
/// into `log`, the function restores the older log. The files are then the same as after a run that
/// ended normally without a step.
/// @param option the command line option that names the log, such as "--log"
/// @param patience how long to wait until the processes of the killed run have ended
/// @return one line about the older log; "" if there is no older log
/// @throws InputError if another run is writing the log
std::string TakeBackOlder(const std::filesystem::path& log, std::string_view option,
                          Duration patience = Duration::zero());

/// Whether a log contains more than a scenario, a graph and a seal. @throws InputError if the file
/// is not an event log
bool HasSteps(const std::filesystem::path& log);

}  // namespace fogline::log
