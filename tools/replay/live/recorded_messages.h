// The recorded messages of some channels, to be published again in another run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "services/log/run_log.h"

namespace fogline::replay {

class RecordedMessages {
 public:
  /// Reads the messages of these channels (indices in kChannels). @throws InputError
  RecordedMessages(const std::filesystem::path& log, const log::ReadOptions& options,
                   std::vector<std::size_t> channels);

  const std::vector<std::size_t>& channels() const { return channels_; }
  const log::RunLog& run() const { return reader_.run(); }
  /// Number of the steps that the log covers, from 0 to its last step.
  std::int64_t steps() const { return static_cast<std::int64_t>(messages_.size()); }
  /// The message of a step, with the run id of the recorded run; empty if the log lacks the
  /// message.
  /// @param channel index in channels()
  runtime::Bytes Of(std::int64_t step, std::size_t channel) const;
  /// Names the first missing message, such as "step 394 lacks RADAR"; "" if no message is missing.
  std::string FirstGap() const;

 private:
  std::vector<std::size_t> channels_;
  log::RunLogReader reader_;  // owns the bytes of the messages
  std::vector<std::vector<runtime::Bytes>> messages_;
};

/// The channels with these names, separated by commas: "RADAR,LIDAR".
/// @throws InputError if a name is not a channel with a message in each step, or if the world sends
///     this channel. The world is the clock of the run, so its messages cannot come from a log
std::vector<std::size_t> RecordedChannels(std::string_view names);

}  // namespace fogline::replay
