// Protects the log of a run. The runner's LogSealer checks that the file on the disk has the bytes
// that the run's recorder has written. Then it seals the file, so that a later change is noticed.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "services/log/about/log_priority.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/other_build.h"

namespace fogline::runner {

/// The facts about the roles of a run that the runner writes into the log.
struct LoggedRoles {
  runtime::RoleBuilds builds{};                     // the build that each role has reported
  std::optional<log::RealtimePriority> priority{};  // only in real time, if it was examined
};

class LogSealer {
 public:
  /// Remembers the identity of the log file at the start of the run, if there is a file.
  explicit LogSealer(std::filesystem::path log);

  /// @param written for each recorder of the run, the part of the log that it has last reported
  /// @throws std::runtime_error if the log was removed, another file has replaced it, or its bytes
  ///     differ
  void Check(const std::vector<log::WrittenLog>& written) const;
  /// Whether the file has exactly the number of bytes that the recorders have reported.
  bool HasAllTold(const std::vector<log::WrittenLog>& written) const;

  /// Checks the file again. In real time, appends the priority of the roles if it is known and the
  /// log lacks it. Then seals the file.
  /// @param run the run as read from the whole file
  /// @param key signs the seal; nullptr: no signature
  /// @throws std::runtime_error like Check(), or if the seal cannot be written
  void Seal(const log::RunLog& run, const std::vector<log::WrittenLog>& written,
            const LoggedRoles& roles, const runtime::SigningKey* key) const;
  /// Reads and seals the log of a run that ended early. If the log cannot be sealed, the file stays
  /// as it is.
  void SealCutOff(const std::vector<log::WrittenLog>& written, const LoggedRoles& roles,
                  const runtime::SigningKey* key) const noexcept;

 private:
  struct Identity {
    dev_t device;
    ino_t inode;
    bool operator==(const Identity&) const = default;
  };
  std::optional<Identity> Find() const;
  /// @throws std::runtime_error if the log was removed, or is not an event log
  log::EventLogReader Open() const;
  /// Checks the bytes on the disk. @throws std::runtime_error like Check()
  void Check(const log::EventLogReader& file, const std::vector<log::WrittenLog>& written) const;

  std::filesystem::path log_;
  std::optional<Identity> begun_with_;
};

}  // namespace fogline::runner
