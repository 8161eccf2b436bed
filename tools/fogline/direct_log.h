// The log of a run without messages (--transport direct).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "services/recorder/event_log.h"
#include "services/recorder/remains.h"
#include "services/recorder/run_log.h"
#include "services/runtime/other_build.h"
#include "services/runtime/seal.h"
#include "tools/fogline/experiment.h"
#include "tools/fogline/log_keeper.h"

namespace fogline {

/// Writes the messages of a run into a log, and seals it. What the log has already of a run that is
/// resumed is compared instead: it must be the same.
class DirectLog {
 public:
  /// @throws InputError if the file cannot be written
  DirectLog(const ExperimentOptions& options, std::int64_t run_id, const Scenario& scenario);

  /// The next message, in the order of the log.
  /// @throws InputError if the log has another one; std::runtime_error if the disk is full
  void Add(std::int64_t step, const ChannelInfo& channel, std::int64_t utime, Bytes message);
  /// Hands everything to the operating system. @throws std::runtime_error
  void Flush();
  /// The run has come to its end: seals the log. @throws std::runtime_error
  void End(const ExperimentResult& result);
  /// The run was interrupted: seals what there is of it.
  void CutOff();

 private:
  const SealKey* key() const { return key_ ? &*key_ : nullptr; }
  void WriteScenario(const std::string& text);
  /// The next message of the log.
  void Compare(std::int64_t step, const ChannelInfo& channel, Bytes message);

  const std::filesystem::path file_;
  std::optional<EventLogReader> old_;  // while there are steps of it
  Remains remains_;
  std::optional<EventLogWriter> log_;
  std::optional<LogKeeper> keeper_;
  std::optional<SealKey> key_;
  RoleBuilds builds_{};
  RunLog run_;
};

}  // namespace fogline
