// LCM event logs, read by mapping the file. A log of Fogline is a standard LCM event log whose
// event times are simulated times. LCM's own library takes seven calls and a copy of everything for
// each event, written or read, and is not needed for a format as simple as this (LCM, eventlog.c),
// all big endian: sync word 0xEDA1DA01, int64 event number, int64 timestamp in us, int32 channel
// length, int32 data length, channel, data.
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

#include "services/runtime/wire.h"

namespace fogline {

/// The most that an event takes besides its data: its header, and LCM's longest channel name.
inline constexpr std::size_t kMostEventOverhead = 28 + 63;

/// The part of a log that is kept when writing goes on: its first bytes, that many whole events.
struct LogHead {
  std::int64_t bytes = 0;
  std::int64_t events = 0;
};

/// What is in a log by the word of one of its writers: the bytes from `begin` on, up to `bytes`,
/// and their CRC-32 (that of zlib).
struct WrittenLog {
  std::int64_t begin = 0;
  std::int64_t bytes = 0;
  std::uint32_t checksum = 0;
};

/// A recorder that is killed leaves at most a ring of incomplete steps and a torn event behind the
/// last complete step, and has told nothing of them: all that is in so many bytes at the end.
inline constexpr std::int64_t kTailBytes = 1 << 20;

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
  /// What the operating system has of it. The last kTailBytes of an old file's head count as they
  /// were found; what is before them its writer has told.
  const WrittenLog& written() const { return written_; }

 private:
  bool WriteOut();
  /// Adds what the operating system has now.
  void CountWritten(Bytes bytes);
  /// Counts the end of the head that is there. @return false and errno if it cannot be read
  bool CountHead(std::int64_t bytes);
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

/// The place of the first event in `bytes`, from `offset` on, that `accept` recognises. Other bytes
/// may stand before it, such as the end of another event. std::nullopt if there is no such event.
std::optional<std::size_t> FindEvent(Bytes bytes, std::size_t offset,
                                     const std::function<bool(const Event&)>& accept);

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
  /// Reads on behind these bytes, which hold that many events.
  void GoTo(const LogHead& head);
  /// What is wrong with the end of the file, "" if nothing: known once Next() has come to it.
  const std::string& torn() const { return torn_; }
  /// Whether there is not one byte in the file.
  bool empty() const { return content_.empty(); }
  /// Bytes of the complete events read so far.
  std::size_t good_bytes() const { return offset_; }
  /// The events read so far.
  LogHead head() const { return {.bytes = static_cast<std::int64_t>(offset_), .events = events_}; }
  /// All bytes of the file.
  Bytes content() const { return content_; }
  /// Hands out the bytes of the file from one place to another in pieces, and gives the memory of
  /// each back.
  void ReadThrough(std::size_t from, std::size_t to, const std::function<void(Bytes)>& use) const;

 private:
  /// Gives the memory of what is read back to the operating system: it maps the file, and would
  /// keep all of it otherwise.
  void Release();

  Bytes content_;
  std::size_t released_ = 0;  // up to here
  std::size_t offset_ = 0;
  std::int64_t events_ = 0;
  std::string torn_;
};

}  // namespace fogline
