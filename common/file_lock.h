// Keeps a file or folder to one writer at a time.
#pragma once

#include <filesystem>
#include <string_view>

#include "common/clock.h"

namespace fogline {

/// A lock on a file or folder (flock(2)). The kernel removes the lock when the process ends, in
/// whatever way. The lock leaves no trace on the disk. It stops only processes that use FileLock,
/// too. On a file system without locks every process gets the lock.
class FileLock {
 public:
  enum class Kind {
    kOwn,     // for the owner: refused while any other lock is there
    kShared,  // for a process that works for the owner and may outlive it
  };

  /// Opens a file or folder and locks it. A file that is missing is created.
  /// @param option the command line option that names the file, such as "--log"
  /// @param owner the kind of process that has such locks, for the message, such as "run"
  /// @param patience how long to wait until other processes give up their locks
  /// @throws InputError "FILE: error: --log: is being written by another run (pid 4711)", without
  ///     the pid if /proc/locks does not give it. If the file cannot be written, the text says why.
  FileLock(const std::filesystem::path& path, Kind kind, std::string_view option,
           std::string_view owner, Duration patience = Duration::zero());
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int fd_;
};

}  // namespace fogline
