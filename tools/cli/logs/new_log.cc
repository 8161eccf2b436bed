#include "tools/cli/logs/new_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "common/atomic_file.h"
#include "common/errors.h"
#include "common/file.h"
#include "common/process/console.h"
#include "common/text.h"
#include "services/log/event_log.h"

namespace fogline::cli {
namespace {

/// Makes a new empty file. @return false if a file of this name exists @throws InputError
bool Reserve(const std::filesystem::path& log) {
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0 && errno == EEXIST) return false;
  if (file < 0) ThrowIfExhausted(errno, PathText(log));
  if (file < 0) {
    throw InputError(
        fmt::format("{}: error: --log: cannot write: {}", PathText(log), std::strerror(errno)));
  }
  close(file);
  return true;
}

}  // namespace

log::LogGuard PrepareLog(const std::filesystem::path& log, bool force) {
  RequireFolderOf(log, "--log");
  std::error_code ignored;
  if (std::filesystem::exists(log, ignored) && !std::filesystem::is_regular_file(log, ignored)) {
    throw InputError(fmt::format("{}: error: --log: not a file", PathText(log)));
  }
  // /dev/stdout and /proc/self/fd/1 name another file in the recorder's process than in this
  // process.
  if (!IsReplaceable(log)) {
    throw InputError(fmt::format(
        "{}: error: --log: this path names an open file of this process; name a file to write",
        PathText(log)));
  }
  if (const std::string older = log::TakeBackOlder(log, "--log"); !older.empty()) Complain(older);
  // The lock makes the file if the file is missing. If two runs start at the same time, only one of
  // them gets the lock. The other run may have made the file, so the size decides whether the file
  // is new. Even --force does not replace a file that another run is writing.
  auto lock = std::make_unique<FileLock>(log, FileLock::Kind::kOwn, "--log", "run");
  if (std::filesystem::is_empty(log, ignored)) return {log, std::move(lock)};
  if (!force) {
    throw InputError(
        fmt::format("{}: error: --log: the file exists; --force replaces it", PathText(log)));
  }
  if (!log::IsEventLogOrEmpty(log)) {
    throw InputError(fmt::format(
        "{}: error: --log: the file is no event log and is not replaced, even with --force",
        PathText(log)));
  }
  return log::LogGuard::InPlaceOf(log, std::move(lock));
}

log::LogGuard FreshLog(const std::filesystem::path& scenario_file) {
  const std::filesystem::path folder = kDefaultFolder;
  RequireFolderOf(folder / "log", "--log");
  for (int number = 1;; ++number) {
    std::filesystem::path log =
        folder / fmt::format("{}-{}.lcm", scenario_file.stem().string(), number);
    if (Reserve(log)) return log::LogGuard(log);
  }
}

}  // namespace fogline::cli
