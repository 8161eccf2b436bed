// LCM event logs, read by mapping the file. A log of Fogline is a standard LCM event log whose
// event times are simulated times. LCM's own library takes seven calls and a copy of everything for
// each event, written or read, and is not needed for a format as simple as this (LCM, eventlog.c),
// all big endian: sync word 0xEDA1DA01, int64 event number, int64 timestamp in us, int32 channel
// length, int32 data length, channel, data.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/runtime/wire.h"

namespace fogline {

/// The part of a log that is kept when writing goes on: its first bytes, that many whole events.
struct LogHead {
  std::int64_t bytes = 0;
  std::int64_t events = 0;
};

/// What is in a log by the word of its writer: its first bytes, and their CRC-32 (that of zlib).
struct WrittenLog {
  std::int64_t bytes = 0;
  std::uint32_t checksum = 0;
};

/// Appends events to a new file, or to the head of an old one.
class EventLogWriter {
 public:
  /// Opens the file for writing; an existing one is replaced. @throws InputError if it cannot
  explicit EventLogWriter(const std::filesystem::path& file);
  /// Cuts an existing file behind `head` and goes on there. @throws InputError if it cannot
  EventLogWriter(const std::filesystem::path& file, const LogHead& head);
  ~EventLogWriter();
  EventLogWriter(const EventLogWriter&) = delete;
  EventLogWriter& operator=(const EventLogWriter&) = delete;

  /// @throws std::runtime_error, such as when the disk is full
  void Write(std::string_view channel, std::int64_t utime, Bytes data);
  /// Hands everything written so far to the operating system: it survives a kill -9 of this
  /// process.
  /// @throws std::runtime_error
  void Flush();
  /// Bytes of all events so far, whether written already or not.
  std::int64_t size() const { return size_; }
  /// The same, and how many events.
  LogHead head() const { return {.bytes = size_, .events = events_}; }
  /// What the operating system has of it. The head of an old file counts as it was found.
  const WrittenLog& written() const { return written_; }

 private:
  bool WriteOut();
  /// Adds what the operating system has now.
  void CountWritten(Bytes bytes);
  /// @return false and errno if it cannot be read
  bool ReadHead(std::int64_t bytes);
  [[noreturn]] void FailToWrite() const;

  std::filesystem::path file_;
  std::FILE* out_;  // without a buffer of its own
  std::int64_t events_ = 0;
  std::int64_t size_ = 0;
  WrittenLog written_;
  std::vector<std::uint8_t> pending_;  // events that are not written yet
};

/// Adds an event to bytes that are to be a log.
void AppendEvent(std::int64_t number, std::string_view channel, std::int64_t utime, Bytes data,
                 std::vector<std::uint8_t>& bytes);

/// A file that may be replaced by a log: an event log by its first bytes, or empty.
bool IsEventLogOrEmpty(const std::filesystem::path& file);

/// One event; views into the mapped file.
struct Event {
  std::int64_t number;
  std::int64_t utime;
  std::string_view channel;
  Bytes data;
};

/// The event that `bytes` begin with.
/// @param why is set to what is wrong, if there is none
std::optional<Event> ParseEvent(Bytes bytes, std::string_view& why);
/// Bytes that an event takes in a file.
std::size_t SizeInFile(const Event& event);

/// Reads a log from front to back without copying. A torn tail (a last event that is incomplete, as
/// a kill or a full disk leaves it) ends the log and is named by torn().
class EventLogReader {
 public:
  /// @throws InputError if the file cannot be read or does not begin like an event log
  explicit EventLogReader(const std::filesystem::path& file);
  ~EventLogReader();
  EventLogReader(const EventLogReader&) = delete;
  EventLogReader& operator=(const EventLogReader&) = delete;

  /// The next event, or nothing at the end or at a torn tail.
  std::optional<Event> Next();
  /// What is wrong with the end of the file, "" if nothing: known once Next() has come to it.
  const std::string& torn() const { return torn_; }
  /// Bytes of the complete events read so far.
  std::size_t good_bytes() const { return offset_; }
  /// The events read so far.
  LogHead head() const { return {.bytes = static_cast<std::int64_t>(offset_), .events = events_}; }
  /// All bytes of the file.
  Bytes content() const { return content_; }

 private:
  Bytes content_;
  std::size_t offset_ = 0;
  std::int64_t events_ = 0;
  std::string torn_;
};

}  // namespace fogline
