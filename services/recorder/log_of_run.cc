#include "services/recorder/log_of_run.h"

#include <system_error>
#include <utility>

#include "scenario/loader.h"
#include "services/recorder/event_log.h"
#include "services/recorder/log_seal.h"

namespace fogline {
namespace {

/// Whether a file can be removed because it has no step. A file that cannot be read is kept.
bool IsInVain(const std::filesystem::path& log) {
  try {
    return !HasSteps(log);
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

LogOfRun::LogOfRun(const std::filesystem::path& log)
    : LogOfRun(log, std::make_unique<FileLock>(log, FileLock::Kind::kOwn, "--log", "run")) {}

LogOfRun::LogOfRun(std::filesystem::path log, std::unique_ptr<FileLock> lock)
    : path_(std::move(log)), lock_(std::move(lock)) {}

LogOfRun::~LogOfRun() {
  if (lock_ == nullptr || !IsInVain(path_)) return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

bool HasSteps(const std::filesystem::path& log) {
  EventLogReader reader(log);
  while (const auto event = reader.Next()) {
    if (event->channel != ChannelOf<run_t>().name && !IsLogSeal(*event)) return true;
  }
  return false;
}

}  // namespace fogline
