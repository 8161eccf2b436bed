// Reads LCM event logs by mapping the file, and writes them. A log of Fogline is a standard LCM
// event log whose event times are simulated times. LCM's own library is not used, because it needs
// seven calls and a copy of all data for each event. The format is simple (LCM, eventlog.c). All
// numbers of an event are big endian, in this order: sync word 0xEDA1DA01, int64 event number,
// int64 timestamp in us, int32 channel length, int32 data length, channel, data.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/graph.h"
#include "services/runtime/wire/wire.h"

namespace fogline::log {

/// The bytes before an event's channel: sync word (4), number (8), time (8), and the lengths of
/// channel and data (4 each).
inline constexpr std::size_t kEventHeader = 28;
/// Largest size of an event without its data, in bytes.
inline constexpr std::size_t kMostEventOverhead = kEventHeader + runtime::kLongestChannel;

/// The beginning of a log: its first bytes, and the number of whole events in them. A writer that
/// continues a log does not change this beginning.
struct LogHead {
  std::int64_t bytes = 0;
  std::int64_t events = 0;
};

/// The part of a log that a recorder has written, as the recorder reports it in its STATUS. The
/// part begins at offset `begin` and ends before offset `bytes`. `checksum` is its CRC-32 (as zlib
/// computes it).
struct WrittenLog {
  std::int64_t begin = 0;
  std::int64_t bytes = 0;
  std::uint32_t checksum = 0;
};

/// Size of the tail of a log, in bytes. The tail contains all bytes after the last complete step. A
/// killed recorder leaves there at most kRingSteps (64) incomplete steps and a torn event. It has
/// written these bytes, but may not have reported them (WrittenLog). The tail has 128 KiB for each
/// channel, which is space for 87 messages of the largest size.
inline constexpr std::int64_t kTailBytes = static_cast<std::int64_t>(kNumChannels) * (128 << 10);

/// Appends events to a new file, or continues an old file after a given LogHead.
class EventLogWriter {
 public:
  /// Opens the file for writing and replaces an existing file. @throws InputError if that fails
  explicit EventLogWriter(const std::filesystem::path& file);
  /// Truncates an existing file after `head`, and continues the file there. @throws InputError if
  /// that fails
  EventLogWriter(const std::filesystem::path& file, const LogHead& head);
  ~EventLogWriter();
  EventLogWriter(const EventLogWriter&) = delete;
  EventLogWriter& operator=(const EventLogWriter&) = delete;

  /// @throws std::runtime_error, for example if the disk is full
  void Write(std::string_view channel, std::int64_t utime, runtime::Bytes data);
  /// Hands all bytes written so far to the operating system, so that these bytes are not lost if
  /// this process is killed (kill -9).
  /// @throws std::runtime_error
  void Flush();
  /// Number of bytes of all events so far, including the events that Flush() has not handed over
  /// yet.
  std::int64_t size() const { return size_; }
  /// The number of bytes of all events so far (size()), and the number of these events.
  LogHead head() const { return {.bytes = size_, .events = events_}; }
  /// The part of the log that was handed to the operating system. In a continued log, this part
  /// begins with the last kTailBytes of the old log, as read from the file. The WrittenLog of the
  /// earlier writer covers the bytes before this part.
  const WrittenLog& written() const { return written_; }

 private:
  bool WriteOut();
  /// Counts bytes in written_ after they were handed to the operating system.
  void CountWritten(runtime::Bytes bytes);
  /// Reads the last kTailBytes of the head and adds them to written_.
  /// @return false, with errno, if these bytes cannot be read
  bool CountHead(std::int64_t bytes);
  [[noreturn]] void FailToWrite() const;

  std::filesystem::path file_;
  std::FILE* out_;  // the file, without a buffer in the C library
  std::int64_t events_ = 0;
  std::int64_t size_ = 0;
  WrittenLog written_;
  std::vector<std::uint8_t> pending_;  // events that are not written yet
};

/// Appends an event to the bytes of a log.
void AppendEvent(std::int64_t number, std::string_view channel, std::int64_t utime,
                 runtime::Bytes data, std::vector<std::uint8_t>& bytes);

/// Appends an event after the last event of a log.
/// @param before the known events of the log
/// @return `before` and the new event
/// @throws std::runtime_error if the event cannot be written; the error says whether the log is
///     unchanged, or contains a part of the event
LogHead AppendToLog(const std::filesystem::path& log, const LogHead& before,
                    std::string_view channel, std::int64_t utime, runtime::Bytes data);

/// Whether the file begins like an event log or is empty, so that a log may replace it.
bool IsEventLogOrEmpty(const std::filesystem::path& file);

/// One event. `channel` and `data` are views into the mapped file.
struct Event {
  std::int64_t number;
  std::int64_t utime;
  std::string_view channel;
  runtime::Bytes data;
};

/// The event at the beginning of `bytes`; nullopt if there is no whole event.
/// @param why is set to the reason if there is no whole event
std::optional<Event> ParseEvent(runtime::Bytes bytes, std::string_view& why);
/// The size of an event in a file, in bytes.
std::size_t SizeInFile(const Event& event);

/// The offset of the first event in `bytes`, from `offset` on, for which `accept` returns true;
/// nullopt if there is no such event. Other bytes may precede this event, such as the end of
/// another event.
std::optional<std::size_t> FindEvent(runtime::Bytes bytes, std::size_t offset,
                                     const std::function<bool(const Event&)>& accept);

/// Reads a log from its beginning to its end without copying. A torn tail (an incomplete last
/// event, which a kill or a full disk leaves) ends the log. torn() describes the torn tail.
class EventLogReader {
 public:
  /// @throws InputError if the file cannot be read or does not begin like an event log
  explicit EventLogReader(const std::filesystem::path& file);
  ~EventLogReader();
  EventLogReader(const EventLogReader&) = delete;
  EventLogReader& operator=(const EventLogReader&) = delete;

  /// The next event; nullopt at the end or at a torn tail.
  std::optional<Event> Next();
  /// After this call, Next() continues after `head`.
  void GoTo(const LogHead& head);
  /// Description of the torn tail; "" if there is no torn tail. Known after Next() has reached the
  /// end.
  const std::string& torn() const { return torn_; }
  /// Whether the file has no bytes.
  bool empty() const { return content_.empty(); }
  /// Number of bytes of the complete events that have been read so far.
  std::size_t good_bytes() const { return offset_; }
  /// The part of the log that has been read so far.
  LogHead head() const { return {.bytes = static_cast<std::int64_t>(offset_), .events = events_}; }
  /// All bytes of the file.
  runtime::Bytes content() const { return content_; }
  /// Calls `use` with the bytes of the file from `from` up to `to`, in pieces, and releases the
  /// memory of each piece.
  void ReadThrough(std::size_t from, std::size_t to,
                   const std::function<void(runtime::Bytes)>& use) const;

 private:
  /// Releases the memory of the bytes that have been read. Without this call, the mapped file would
  /// stay in memory.
  void Release();

  runtime::Bytes content_;
  std::size_t released_ = 0;  // memory is released up to this offset
  std::size_t offset_ = 0;
  std::int64_t events_ = 0;
  std::string torn_;
};

}  // namespace fogline::log
