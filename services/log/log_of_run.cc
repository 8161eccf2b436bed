#include "services/log/log_of_run.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "common/errors.h"
#include "services/log/event_log.h"
#include "services/log/log_seal.h"

namespace fogline::log {
namespace {

/// Whether a file can be removed because it has no step. A file that cannot be read is kept.
bool IsInVain(const std::filesystem::path& log) {
  try {
    return !HasSteps(log);
  } catch (const InputError&) {
    return false;
  }
}

/// Makes an empty file with a new name in the folder of `file`. It has the same rights as `file`.
std::optional<std::filesystem::path> EmptyFileBeside(const std::filesystem::path& file) {
  struct stat info {};
  std::string name = (file.parent_path() / ".fogline-XXXXXX").string();
  const int fd = stat(file.c_str(), &info) == 0 ? mkstemp(name.data()) : -1;
  if (fd < 0) return std::nullopt;
  const bool same_rights = fchmod(fd, info.st_mode & 0777) == 0;
  close(fd);
  if (same_rights) return name;
  unlink(name.c_str());
  return std::nullopt;
}

}  // namespace

LogOfRun::LogOfRun(const std::filesystem::path& log)
    : LogOfRun(log, std::make_unique<FileLock>(log, FileLock::Kind::kOwn, "--log", "run")) {}

LogOfRun::LogOfRun(std::filesystem::path log, std::unique_ptr<FileLock> lock)
    : path_(std::move(log)), lock_(std::move(lock)) {}

LogOfRun LogOfRun::InPlaceOf(const std::filesystem::path& log, std::unique_ptr<FileLock> lock) {
  std::error_code ignored;
  const std::filesystem::path place = std::filesystem::canonical(log, ignored);
  const std::optional<std::filesystem::path> empty = EmptyFileBeside(place);
  if (!empty) return {log, std::move(lock)};
  auto own = std::make_unique<FileLock>(*empty, FileLock::Kind::kOwn, "--log", "run");
  if (renameat2(AT_FDCWD, empty->c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) != 0) {
    std::filesystem::remove(*empty, ignored);
    return {log, std::move(lock)};
  }
  LogOfRun result(log, std::move(own));
  result.older_ = *empty;
  return result;
}

LogOfRun::~LogOfRun() {
  if (lock_ == nullptr) return;
  std::error_code ignored;
  const bool in_vain = IsInVain(path_);
  if (!older_.empty() && in_vain) {
    std::filesystem::rename(older_, std::filesystem::canonical(path_, ignored), ignored);
  } else if (!older_.empty()) {
    std::filesystem::remove(older_, ignored);
  } else if (in_vain) {
    std::filesystem::remove(path_, ignored);
  }
}

bool HasSteps(const std::filesystem::path& log) {
  EventLogReader reader(log);
  while (const auto event = reader.Next()) {
    if (event->channel != ChannelOf<run_t>().name && !IsLogSeal(*event)) return true;
  }
  return false;
}

}  // namespace fogline::log
