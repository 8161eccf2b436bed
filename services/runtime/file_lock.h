// Keeps a file or folder to one writer at a time.
#pragma once

#include <filesystem>
#include <string_view>

#include "services/runtime/clock.h"

namespace fogline {

/// A lock on a file or folder (flock(2)). The kernel takes it away when the process ends, however
/// it ends, and nothing is left on the disk. It binds only those that ask for it. On a file system
/// without locks every process gets it.
class FileLock {
 public:
  enum class Kind {
    kOwn,     // refused while any other lock is there
    kShared,  // beside the owner's, for a process that works for the owner and may outlive it
  };

  /// Opens the file, which is made if it is missing, or the folder, and locks it.
  /// @param option that names it, such as "--log"
  /// @param owner what else may have it: "run"
  /// @param patience wait so long for others to end that have it
  /// @throws InputError "FILE: error: --log: is being written by another run (pid 4711)", without
  ///     the pid where /proc/locks does not say it; or why the file cannot be written
  FileLock(const std::filesystem::path& path, Kind kind, std::string_view option,
           std::string_view owner, Duration patience = Duration::zero());
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int fd_;
};

}  // namespace fogline
