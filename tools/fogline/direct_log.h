// The log of a run without messages (--transport direct).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/recorder/event_log.h"
#include "tools/fogline/experiment.h"

namespace fogline {

/// Writes the messages of a run into a log. What the log has already of a run that is resumed is
/// compared instead: it must be the same.
class DirectLog {
 public:
  /// @throws InputError if the file cannot be written
  DirectLog(const ExperimentOptions& options, std::int64_t run_id,
            const std::string& scenario_text);

  /// The next message, in the order of the log.
  /// @throws InputError if the log has another one; std::runtime_error if the disk is full
  void Add(std::int64_t step, const ChannelInfo& channel, std::int64_t utime, Bytes message);
  /// Hands everything to the operating system. @throws std::runtime_error
  void Flush();

 private:
  /// The next message of the log.
  void Compare(std::int64_t step, const ChannelInfo& channel, Bytes message);

  const std::filesystem::path file_;
  std::optional<EventLogReader> old_;  // while there are steps of it
  Remains remains_;
  std::optional<EventLogWriter> log_;
};

}  // namespace fogline
