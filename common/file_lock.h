// Allows only one writer at a time for a file or folder.
#pragma once

#include <filesystem>
#include <string_view>

#include "common/clock.h"

namespace fogline {

/// A lock on a file or folder (flock(2)). The kernel removes the lock when the process ends, also
/// after a crash. The lock leaves no trace on the disk. The lock affects only processes that use
/// FileLock. On a file system without locks every process gets the lock.
class FileLock {
 public:
  enum class Kind {
    kOwn,     // for the owner: refused while any other lock exists
    kShared,  // for a process that works for the owner and may end after the owner
  };

  /// Opens a file or folder and locks it. A file that is missing is created.
  /// @param option the command line option that names the file, such as "--log"
  /// @param owner the kind of owner that the error message names, such as "run"
  /// @param patience longest wait until other processes release their locks
  /// @throws InputError "FILE: error: --log: is being written by another run (pid 4711)", without
  ///     the pid if /proc/locks does not give it. If the file cannot be written, or another process
  ///     replaces it repeatedly, the text says so.
  FileLock(const std::filesystem::path& path, Kind kind, std::string_view option,
           std::string_view owner, Duration patience = Duration::zero());
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int fd_;
};

}  // namespace fogline
