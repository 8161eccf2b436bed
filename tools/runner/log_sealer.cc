#include "tools/runner/log_sealer.h"

#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "services/runtime/wire/digest.h"

namespace fogline::runner {
namespace {

std::int64_t TimeOfStep(std::int64_t step, const Scenario& scenario) {
  return std::max<std::int64_t>(0, step) * std::llround(scenario.step_s * kMicrosPerSecond);
}

log_seal_t SealOf(const log::RunLog& run, const runtime::RoleBuilds& builds) {
  log_seal_t seal{};
  seal.header = {.run_id = run.run_id,
                 .step = run.steps - 1,
                 .utime = TimeOfStep(run.steps - 1, run.scenario)};
  seal.digest = run.digest;
  seal.steps = run.steps;
  seal.complete = run.ended;
  seal.scenario_hash = run.scenario_hash;
  seal.version = FOGLINE_VERSION;
  for (const RoleInfo& info : kRoles) {
    seal.role.emplace_back(info.name);
    seal.build_id.push_back(builds[static_cast<std::size_t>(info.role)]);
  }
  seal.num_roles = static_cast<std::int32_t>(seal.role.size());
  return seal;
}

}  // namespace

LogSealer::LogSealer(std::filesystem::path log) : log_(std::move(log)), begun_with_(Find()) {}

std::optional<LogSealer::Identity> LogSealer::Find() const {
  struct stat info {};
  if (stat(log_.c_str(), &info) != 0) return std::nullopt;
  return Identity{.device = info.st_dev, .inode = info.st_ino};
}

void LogSealer::Check(const log::EventLogReader& file,
                      const std::vector<log::WrittenLog>& written) const {
  if (begun_with_ && Find() != begun_with_) {
    throw std::runtime_error(fmt::format(
        "{}: the log is not the file that the run began with: it was replaced meanwhile",
        log_.string()));
  }
  if (const std::string why = log::WhyNotWritten(file, written); !why.empty()) {
    throw std::runtime_error(fmt::format("{}: {}", log_.string(), why));
  }
}

void LogSealer::Check(const std::vector<log::WrittenLog>& written) const { Check(Open(), written); }

log::EventLogReader LogSealer::Open() const {
  std::error_code unknown;
  if (std::filesystem::status(log_, unknown).type() == std::filesystem::file_type::not_found) {
    throw std::runtime_error(fmt::format("{}: the log was removed during the run", PathText(log_)));
  }
  try {
    return log::EventLogReader(log_);
  } catch (const InputError& error) {  // no mistake of the user: the run made this file
    throw std::runtime_error(error.what());
  }
}

bool LogSealer::HasAllTold(const std::vector<log::WrittenLog>& written) const {
  std::error_code missing;
  const auto told = std::ranges::max_element(written, {}, &log::WrittenLog::bytes);
  return told != written.end() &&
         std::filesystem::file_size(log_, missing) == static_cast<std::uintmax_t>(told->bytes);
}

void LogSealer::Seal(const log::RunLog& run, const std::vector<log::WrittenLog>& written,
                     const LoggedRoles& roles, const runtime::SigningKey* key) const {
  Check(written);
  log::LogHead events = run.events;
  if (roles.priority && run.realtime && !run.realtime->priority) {
    events = log::AppendToLog(log_, events, log::kLogPriorityChannel, 0,
                              log::EncodePriority(*roles.priority, run.run_id));
  }
  log_seal_t seal = SealOf(run, roles.builds);
  const log::EventLogReader file = Open();
  runtime::Hash hash;
  file.ReadThrough(0, file.content().size(), [&hash](runtime::Bytes piece) { hash.Add(piece); });
  seal.file_hash = hash.Hex();
  log::SealLog(log_, events, std::move(seal), key);
}

void LogSealer::SealCutOff(const std::vector<log::WrittenLog>& written, const LoggedRoles& roles,
                           const runtime::SigningKey* key) const noexcept {
  try {
    if (!HasAllTold(written)) return;
    Check(written);
    log::RunLogReader reader(log_);
    while (reader.Next() != nullptr) {
    }
    // If the log ends with an incomplete event, it gets no seal. A seal behind this event would
    // look like a part of the event.
    if (!std::cmp_equal(reader.run().events.bytes, std::filesystem::file_size(log_))) return;
    Seal(reader.run(), written, roles, key);
  } catch (const std::exception&) {  // the error that ended the run is more important
  }
}

}  // namespace fogline::runner
