#include "services/log/log_guard.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "services/log/about/log_graph.h"
#include "services/log/event_log.h"
#include "services/log/log_seal.h"

namespace fogline::log {
namespace {

/// Whether a file can be removed because it has no step. A file that cannot be read is kept.
bool IsInVain(const std::filesystem::path& log) {
  try {
    return !HasSteps(log);
  } catch (const std::exception&) {
    return false;
  }
}

/// The name that the older log gets while a run writes a new log in its place. A later run finds
/// the older log by this name. @param place path of the log, without symbolic links
std::filesystem::path OlderOf(const std::filesystem::path& place) {
  return place.parent_path() / (".fogline-older-" + place.filename().string());
}

/// Makes an empty file with the name that OlderOf() returns. The new file has the same permissions
/// as `file`.
std::optional<std::filesystem::path> EmptyFileBeside(const std::filesystem::path& file) {
  struct stat info {};
  std::filesystem::path name = OlderOf(file);
  const int fd = stat(file.c_str(), &info) == 0
                     ? open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)
                     : -1;
  if (fd < 0) return std::nullopt;
  const bool same_rights = fchmod(fd, info.st_mode & 0777) == 0;
  close(fd);
  if (same_rights) return name;
  unlink(name.c_str());
  return std::nullopt;
}

bool IsOlderLog(const std::filesystem::path& file) {
  std::error_code missing;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(file, missing)) &&
         IsEventLogOrEmpty(file);
}

}  // namespace

LogGuard::LogGuard(const std::filesystem::path& log)
    : LogGuard(log, std::make_unique<FileLock>(log, FileLock::Kind::kOwn, "--log", "run")) {}

LogGuard::LogGuard(std::filesystem::path log, std::unique_ptr<FileLock> lock)
    : path_(std::move(log)), lock_(std::move(lock)) {}

LogGuard LogGuard::InPlaceOf(const std::filesystem::path& log, std::unique_ptr<FileLock> lock) {
  std::error_code ignored;
  const std::filesystem::path place = std::filesystem::canonical(log, ignored);
  const std::optional<std::filesystem::path> empty = EmptyFileBeside(place);
  if (!empty) return {log, std::move(lock)};
  auto own = std::make_unique<FileLock>(*empty, FileLock::Kind::kOwn, "--log", "run");
  if (renameat2(AT_FDCWD, empty->c_str(), AT_FDCWD, place.c_str(), RENAME_EXCHANGE) != 0) {
    std::filesystem::remove(*empty, ignored);
    return {log, std::move(lock)};
  }
  LogGuard result(log, std::move(own));
  result.older_ = *empty;
  return result;
}

LogGuard::~LogGuard() {
  if (lock_ == nullptr) return;
  std::error_code ignored;
  const bool in_vain = IsInVain(path_);
  if (!older_.empty() && in_vain) {
    std::filesystem::rename(older_, std::filesystem::canonical(path_, ignored), ignored);
  } else if (!older_.empty()) {
    std::filesystem::remove(older_, ignored);
  } else if (in_vain) {
    // If path_ is a symbolic link, the log is removed, but not the link.
    std::filesystem::remove(std::filesystem::canonical(path_, ignored), ignored);
  }
}

void LogGuard::RemoveOlder() {
  if (older_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(older_, ignored);
  older_.clear();
}

std::string TakeBackOlder(const std::filesystem::path& log, std::string_view option,
                          Duration patience) {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::weakly_canonical(log, error);
  const std::filesystem::path older = OlderOf(place);
  if (error || !IsOlderLog(older)) return "";
  const FileLock lock(log, FileLock::Kind::kOwn, option, "run", patience);
  if (!IsOlderLog(older)) return "";              // the run that moved it has ended normally
  if (std::filesystem::is_empty(older, error)) {  // that run was killed before the exchange
    std::filesystem::remove(older, error);
    return "";
  }
  if (IsInVain(place)) {
    std::filesystem::rename(older, place, error);
    if (!error) {
      return fmt::format(
          "{}: the older log is back: the run that was to replace it was killed before its first "
          "step",
          PathText(log));
    }
  }
  return fmt::format(
      "{}: a killed run has left {}, an older log of this name; remove it if you do not need it",
      PathText(log), PathText(older));
}

bool HasSteps(const std::filesystem::path& log) {
  EventLogReader reader(log);
  while (const auto event = reader.Next()) {
    const bool is_front =
        event->channel == ChannelOf<run_t>().name || event->channel == kLogGraphChannel;
    if (!is_front && !IsLogSeal(*event)) return true;
  }
  return false;
}

}  // namespace fogline::log
