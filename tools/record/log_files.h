// Writes events into one log, or into several logs one after another.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "common/clock.h"
#include "services/log/event_log.h"

namespace fogline::record {

/// Limits of a file. An event that would exceed a limit is written into the next file. Without a
/// limit there is one file.
struct Rotation {
  std::int64_t most_bytes = 0;  // size of a file; 0: no limit
  Duration longest{};           // time since the file was begun; 0: no limit

  bool Any() const { return most_bytes > 0 || longest > Duration::zero(); }
};

/// The files of a recording: "day.lcm", or with a rotation "day-000.lcm", "day-001.lcm" and so on.
/// Every file is a complete event log, whose events are numbered from 0 on. With a rotation, files
/// of an earlier recording with the same name are removed.
class LogFiles {
 public:
  /// Begins the first file, and replaces an existing file of this name. With a rotation, also
  /// removes all other files that InTheWay() finds.
  /// @throws InputError
  LogFiles(std::filesystem::path file, const Rotation& rotation, TimePoint now);

  /// Appends an event.
  /// @throws std::runtime_error, for example if the disk is full; the file then ends with the last
  ///     complete event that was written
  void Write(const log::Event& event, TimePoint now);
  /// Gives all events to the operating system. @throws like Write()
  void Flush();

  const std::vector<std::filesystem::path>& files() const { return files_; }
  std::int64_t bytes() const { return earlier_bytes_ + (log_ ? log_->size() : 0); }
  /// Number of files of an earlier recording that were removed.
  std::int64_t removed() const { return removed_; }

  /// The name of file number `number` of a recording with a rotation.
  static std::filesystem::path NameOf(const std::filesystem::path& file, std::size_t number);
  /// All existing files whose name is the result of NameOf() for any number.
  static std::vector<std::filesystem::path> InTheWay(const std::filesystem::path& file);

 private:
  void Begin(TimePoint now);
  void RemoveEarlierRecording();
  /// Removes an incomplete event from the end of the file.
  void CutTornEvent();

  std::filesystem::path file_;
  Rotation rotation_;
  std::vector<std::filesystem::path> files_;
  std::optional<log::EventLogWriter> log_;
  std::vector<std::int64_t> ends_;  // offset of the end of each event that is not flushed yet
  std::int64_t flushed_ = 0;        // number of bytes in the file before these events
  std::int64_t earlier_bytes_ = 0;
  std::int64_t removed_ = 0;
  TimePoint begun_{};
};

}  // namespace fogline::record
