#include "common/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/file.h"
#include "common/text.h"

namespace fogline {
namespace {

// A file may be removed or replaced after FileLock has opened it and before FileLock locks it. Then
// FileLock opens the file again, but not more than this number of times in total.
constexpr int kTries = 10;
// While another process holds the lock, FileLock tries again at this interval.
constexpr Duration kTryEvery = milliseconds(10);

/// @throws InputError
int Open(const std::filesystem::path& path, std::string_view option) {
  std::error_code ignored;
  const bool is_folder = std::filesystem::is_directory(path, ignored);
  const int fd = open(path.c_str(), (is_folder ? O_RDONLY : O_RDWR | O_CREAT) | O_CLOEXEC, 0666);
  if (fd >= 0) return fd;
  ThrowIfExhausted(errno, PathText(path));
  throw InputError(
      fmt::format("{}: error: {}: cannot write: {}", PathText(path), option, std::strerror(errno)));
}

/// Whether `path` is still the name of the open file `fd`.
bool IsFileOf(const std::filesystem::path& path, int fd) {
  struct stat named {};
  struct stat opened {};
  return stat(path.c_str(), &named) == 0 && fstat(fd, &opened) == 0 &&
         named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

/// @return false if a lock of another process prevents this lock
bool Lock(int fd, FileLock::Kind kind) {
  const auto take = [fd](int how) { return flock(fd, how | LOCK_NB) == 0 || errno != EWOULDBLOCK; };
  // An owner takes an exclusive lock first, to make sure that no other lock exists. Then the owner
  // keeps only a shared lock, so that processes that work for the owner can lock the file, too.
  return (kind == FileLock::Kind::kShared || take(LOCK_EX)) && take(LOCK_SH);
}

/// The parent of a process, 0 if the process has ended. /proc/PID/stat is "4711 (name) S 4710 ...".
pid_t ParentOf(pid_t pid) {
  std::ifstream stat(fmt::format("/proc/{}/stat", pid));
  std::string text;
  std::getline(stat, text);
  std::istringstream words(text.substr(text.rfind(')') + 1));
  std::string state;
  pid_t parent = 0;
  words >> state >> parent;
  return parent;
}

/// The process that has locked an open file. Several processes can hold one lock: an owner, and
/// processes that the owner has started. The function returns the owner: the process whose parent
/// does not hold the lock. /proc/locks has lines "1: FLOCK ADVISORY READ 4711 08:01:1234 0 EOF",
/// with the device in hexadecimal and the inode.
std::optional<pid_t> HolderOf(int fd) {
  struct stat file {};
  if (fstat(fd, &file) != 0) return std::nullopt;
  const std::string place =
      fmt::format("{:02x}:{:02x}:{}", major(file.st_dev), minor(file.st_dev), file.st_ino);
  std::vector<pid_t> holders;
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, type, advisory, access, where;
    pid_t pid = 0;
    words >> number >> type >> advisory >> access >> pid >> where;
    if (type != "FLOCK" || where != place || pid <= 0) continue;
    holders.push_back(pid);
  }
  const auto owner = std::ranges::find_if(holders, [&](pid_t pid) {
    return std::ranges::find(holders, ParentOf(pid)) == holders.end();
  });
  return owner == holders.end() ? std::nullopt : std::optional(*owner);
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& path, Kind kind, std::string_view option,
                   std::string_view owner, Duration patience) {
  const TimePoint end = Clock::now() + patience;
  for (int tries = 1;; ++tries) {
    fd_ = Open(path, option);
    while (!Lock(fd_, kind)) {
      if (Clock::now() < end) {
        std::this_thread::sleep_for(kTryEvery);
        continue;
      }
      const std::optional<pid_t> holder = HolderOf(fd_);
      close(fd_);
      throw InputError(fmt::format("{}: error: {}: is being written by another {}{}",
                                   PathText(path), option, owner,
                                   holder ? fmt::format(" (pid {})", *holder) : ""));
    }
    if (IsFileOf(path, fd_)) return;
    close(fd_);
    if (tries == kTries) {
      throw InputError(
          fmt::format("{}: error: {}: is replaced repeatedly", PathText(path), option));
    }
  }
}

FileLock::~FileLock() { close(fd_); }

}  // namespace fogline
