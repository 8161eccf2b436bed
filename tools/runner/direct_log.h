// The log of a run without messages (--transport direct).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "services/log/event_log.h"
#include "services/log/remains.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/message_signer.h"
#include "services/runtime/wire/other_build.h"
#include "tools/runner/log_sealer.h"
#include "tools/runner/scenario_run.h"

namespace fogline::runner {

/// Writes the messages of a run into a log, and seals it. For a resumed run, this class compares
/// the messages with the messages that the log already has: both must be equal.
class DirectLog {
 public:
  /// @throws InputError if the file cannot be written
  DirectLog(const RunOptions& options, std::int64_t run_id, const Scenario& scenario);

  /// Adds the next message, in the order of the log.
  /// @throws InputError if the log has a different message; std::runtime_error if the disk is full
  void Add(std::int64_t step, const ChannelInfo& channel, std::int64_t utime,
           runtime::Bytes message);
  /// Hands all data to the operating system. @throws std::runtime_error
  void Flush();
  /// Seals the log of a complete run. @throws std::runtime_error
  void End(const RunResult& result);
  /// Seals the log of an interrupted run with the steps that it has.
  void CutOff();

 private:
  const runtime::SigningKey* key() const { return key_ ? &*key_ : nullptr; }
  void WriteScenario(const std::string& text);
  /// Compares a message with the next message of the log.
  void Compare(std::int64_t step, const ChannelInfo& channel, runtime::Bytes message);

  const std::filesystem::path file_;
  std::optional<log::EventLogReader> old_;  // nullopt if the old log has no more steps to compare
  log::Remains remains_;
  std::optional<log::EventLogWriter> log_;
  std::optional<LogSealer> sealer_;
  std::optional<runtime::SigningKey> key_;
  runtime::RoleBuilds builds_{};
  log::RunLog run_;
};

}  // namespace fogline::runner
