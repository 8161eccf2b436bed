// The remark on a log: why it is not complete, or what was ignored.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/log/run_log.h"

namespace fogline::log {

/// The steps that were not read, because an earlier step lacks a message.
struct UnreadSteps {
  std::int64_t first = 0;     // the first of these steps of which the log has a message
  runtime::ChannelSet lacks;  // the channels that step `first` lacks
  bool are_end = false;       // whether they are the incomplete steps of a run that ended early
};

/// Facts that a reader has found out about a log, and that RunLog does not have.
struct LogRemarks {
  std::string torn;        // how the file was cut off; "" if it was not
  std::string alteration;  // how the log differs from its seal; "" if not
  std::int64_t first = 0;  // the first step of which a message was read
  // The first step of the messages that come before RUN in the log. These messages were not read.
  std::optional<std::int64_t> before_run;
  bool has_last = false;             // whether the log has the last step of the run
  std::int64_t next = 0;             // the first step that the log does not have
  std::optional<std::int64_t> tail;  // the first of the incomplete steps at the end
  runtime::ChannelSet tail_lacks;    // the channels that step `tail` lacks
  std::optional<UnreadSteps> unread;
  std::int64_t astray = 0;   // steps whose numbers are impossible for the run
  bool unchecked = false;    // whether the log has no hash with which to check a given scenario
  std::string conflict;      // two different messages of one step and channel
  std::int64_t foreign = 0;  // messages of other runs
};

/// The remark; "" if there is no remark. @param run all its fields except `note` are set
std::string NoteOf(const RunLog& run, const LogRemarks& remarks);

}  // namespace fogline::log
