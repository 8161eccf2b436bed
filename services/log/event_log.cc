#include "services/log/event_log.h"

#include <fcntl.h>
#include <libdeflate.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/file.h"
#include "common/process/this_process.h"
#include "common/text.h"

namespace fogline::log {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
// At most this many bytes of a mapped log stay in memory. This amount is small for a process, but
// large enough that each call of madvise() releases many pages.
constexpr std::size_t kMostMapped = 4 << 20;

std::uint32_t ReadUint32(runtime::Bytes bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = (value << 8) | bytes[offset + i];
  return value;
}

template <class Unsigned>
void PutBigEndian(Unsigned value, std::uint8_t* to) {
  auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(value)>>(value);
  if constexpr (std::endian::native == std::endian::little) std::ranges::reverse(bytes);
  std::memcpy(to, bytes.data(), sizeof(value));
}

}  // namespace

bool IsEventLogOrEmpty(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<std::uint8_t, sizeof(kSyncWord)> head{};
  in.read(reinterpret_cast<char*>(head.data()), std::ssize(head));
  return in.gcount() == 0 ? in.eof() : in.good() && ReadUint32(head, 0) == kSyncWord;
}

EventLogWriter::EventLogWriter(const std::filesystem::path& file)
    : file_(file), out_(std::fopen(file.c_str(), "wb")) {
  if (out_ == nullptr) {
    ThrowIfExhausted(errno, PathText(file));
    throw InputError(
        fmt::format("{}: error: cannot write the log: {}", PathText(file), std::strerror(errno)));
  }
  std::setvbuf(out_, nullptr, _IONBF, 0);
  pending_.reserve(2 * kWorthACall);
}

EventLogWriter::EventLogWriter(const std::filesystem::path& file, const LogHead& head)
    : file_(file), out_(std::fopen(file.c_str(), "r+b")), events_(head.events), size_(head.bytes) {
  if (out_ != nullptr) std::setvbuf(out_, nullptr, _IONBF, 0);
  if (out_ == nullptr || ftruncate(fileno(out_), head.bytes) != 0 || !CountHead(head.bytes) ||
      std::fseek(out_, head.bytes, SEEK_SET) != 0) {
    const std::string why = std::strerror(errno);
    if (out_ != nullptr) std::fclose(out_);
    throw InputError(fmt::format("{}: error: cannot go on with the log: {}", PathText(file), why));
  }
  pending_.reserve(2 * kWorthACall);
}

EventLogWriter::~EventLogWriter() {
  WriteOut();
  std::fclose(out_);
}

bool EventLogWriter::CountHead(std::int64_t bytes) {
  written_.begin = written_.bytes = std::max<std::int64_t>(0, bytes - kTailBytes);
  if (std::fseek(out_, written_.begin, SEEK_SET) != 0) return false;
  std::vector<std::uint8_t> chunk(kWorthACall);
  while (written_.bytes < bytes) {
    const auto wanted = std::min<std::int64_t>(std::ssize(chunk), bytes - written_.bytes);
    const std::size_t size = std::fread(chunk.data(), 1, static_cast<std::size_t>(wanted), out_);
    if (size == 0) return false;
    CountWritten(runtime::Bytes(chunk).first(size));
  }
  return true;
}

void AppendEvent(std::int64_t number, std::string_view channel, std::int64_t utime,
                 runtime::Bytes data, std::vector<std::uint8_t>& bytes) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + kEventHeader + channel.size() + data.size());
  std::uint8_t* const event = bytes.data() + begin;
  PutBigEndian(kSyncWord, event);
  PutBigEndian(static_cast<std::uint64_t>(number), event + 4);
  PutBigEndian(static_cast<std::uint64_t>(utime), event + 12);
  PutBigEndian(static_cast<std::uint32_t>(channel.size()), event + 20);
  PutBigEndian(static_cast<std::uint32_t>(data.size()), event + 24);
  std::ranges::copy(channel, event + kEventHeader);
  std::ranges::copy(data, event + kEventHeader + channel.size());
}

LogHead AppendToLog(const std::filesystem::path& log, const LogHead& before,
                    std::string_view channel, std::int64_t utime, runtime::Bytes data) {
  std::vector<std::uint8_t> event;
  AppendEvent(before.events, channel, utime, data, event);
  const int fd = open(log.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  const int error =
      fd < 0 ? errno : WriteAll(fd, {reinterpret_cast<const char*>(event.data()), event.size()});
  // If only a part of the event is written, this part is removed. Otherwise the log would look like
  // a log that was cut off.
  const bool left = error != 0 && fd >= 0 && ftruncate(fd, before.bytes) != 0;
  if (fd >= 0) close(fd);
  if (error == 0) {
    return {.bytes = before.bytes + static_cast<std::int64_t>(event.size()),
            .events = before.events + 1};
  }
  throw std::runtime_error(
      fmt::format("cannot append {} to {}: {}; {}", channel, log.string(), WhyWriteFailed(error),
                  left ? "the log contains a part of this event" : "the log is as before"));
}

void EventLogWriter::Write(std::string_view channel, std::int64_t utime, runtime::Bytes data) {
  const std::size_t before = pending_.size();
  AppendEvent(events_++, channel, utime, data, pending_);
  size_ += static_cast<std::int64_t>(pending_.size() - before);
  if (pending_.size() >= kWorthACall) Flush();
}

void EventLogWriter::Flush() {
  if (!WriteOut()) FailToWrite();
}

bool EventLogWriter::WriteOut() {
  const std::size_t written = std::fwrite(pending_.data(), 1, pending_.size(), out_);
  const bool all = written == pending_.size();
  CountWritten(runtime::Bytes(pending_).first(written));
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(written));
  return all;
}

void EventLogWriter::CountWritten(runtime::Bytes bytes) {
  if (bytes.empty()) return;  // with a null buffer, libdeflate_crc32() would reset the checksum
  written_.bytes += std::ssize(bytes);
  written_.checksum = libdeflate_crc32(written_.checksum, bytes.data(), bytes.size());
}

void EventLogWriter::FailToWrite() const {
  throw std::runtime_error(
      fmt::format("cannot write to {}: {}", PathText(file_), WhyWriteFailed(errno)));
}

EventLogReader::EventLogReader(const std::filesystem::path& file) {
  const int fd = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) ThrowIfExhausted(errno, PathText(file));
  struct stat info {};
  if (fd < 0 || fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) {
    std::string why = fd < 0 ? std::strerror(errno) : WhyNoRegularFile(file);
    if (fd < 0 && errno == ENOENT) why += DidYouMeanFile(file);
    if (S_ISDIR(info.st_mode)) why += fmt::format("; its logs are {}", PathText(file / "*.lcm"));
    if (fd >= 0) close(fd);
    throw InputError(fmt::format("{}: error: cannot read the log: {}", PathText(file), why));
  }
  const auto size = static_cast<std::size_t>(info.st_size);
  void* mapped = size == 0 ? nullptr : mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
  close(fd);
  if (mapped == MAP_FAILED) {
    throw InputError(
        fmt::format("{}: error: cannot map the log: {}", PathText(file), std::strerror(errno)));
  }
  if (mapped != nullptr) madvise(mapped, size, MADV_SEQUENTIAL);
  content_ = {static_cast<const std::uint8_t*>(mapped), size};
  if (size > 0 && (size < 4 || ReadUint32(content_, 0) != kSyncWord)) {
    munmap(mapped, size);
    throw InputError(fmt::format("{}: error: not an LCM event log", PathText(file)));
  }
}

EventLogReader::~EventLogReader() {
  if (!content_.empty()) {
    munmap(const_cast<std::uint8_t*>(content_.data()), content_.size());
  }
}

std::optional<Event> ParseEvent(runtime::Bytes bytes, std::string_view& why) {
  why = "cut off";
  if (bytes.size() < kEventHeader) return std::nullopt;
  why = "no event";
  if (ReadUint32(bytes, 0) != kSyncWord) return std::nullopt;
  const std::size_t channel_size = ReadUint32(bytes, 20);
  const std::size_t data_size = ReadUint32(bytes, 24);
  why = "impossible channel name";
  if (channel_size == 0 || channel_size > runtime::kLongestChannel) return std::nullopt;
  why = "cut off";
  if (channel_size + data_size > bytes.size() - kEventHeader) return std::nullopt;
  why = "";
  const auto* channel = reinterpret_cast<const char*>(bytes.data() + kEventHeader);
  return Event{.number = runtime::ReadInt64(bytes, 4),
               .utime = runtime::ReadInt64(bytes, 12),
               .channel = {channel, channel_size},
               .data = bytes.subspan(kEventHeader + channel_size, data_size)};
}

std::size_t SizeInFile(const Event& event) {
  return kEventHeader + event.channel.size() + event.data.size();
}

std::optional<std::size_t> FindEvent(runtime::Bytes bytes, std::size_t offset,
                                     const std::function<bool(const Event&)>& accept) {
  std::array<std::uint8_t, sizeof(kSyncWord)> sync{};
  for (std::size_t i = 0; i < sync.size(); ++i) {
    sync[i] = static_cast<std::uint8_t>(kSyncWord >> (8 * (sync.size() - 1 - i)));
  }
  std::string_view why;
  while (offset < bytes.size()) {
    const void* at = memmem(bytes.data() + offset, bytes.size() - offset, sync.data(), sync.size());
    if (at == nullptr) return std::nullopt;
    offset = static_cast<std::size_t>(static_cast<const std::uint8_t*>(at) - bytes.data());
    if (const auto event = ParseEvent(bytes.subspan(offset), why); event && accept(*event)) {
      return offset;
    }
    ++offset;
  }
  return std::nullopt;
}

void EventLogReader::GoTo(const LogHead& head) {
  offset_ = static_cast<std::size_t>(head.bytes);
  events_ = head.events;
  torn_.clear();
}

void EventLogReader::ReadThrough(std::size_t from, std::size_t to,
                                 const std::function<void(runtime::Bytes)>& use) const {
  static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  while (from < to) {
    const std::size_t end = std::min(to, from + kMostMapped);
    use(content_.subspan(from, end - from));
    const std::size_t begin = from / page * page;
    madvise(const_cast<std::uint8_t*>(content_.data()) + begin, end - begin, MADV_DONTNEED);
    from = end;
  }
}

void EventLogReader::Release() {
  static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t end = offset_ / page * page;
  if (end > released_) {
    madvise(const_cast<std::uint8_t*>(content_.data()) + released_, end - released_, MADV_DONTNEED);
  }
  released_ = end;
}

std::optional<Event> EventLogReader::Next() {
  if (offset_ >= released_ + kMostMapped) Release();
  const runtime::Bytes rest = content_.subspan(offset_);
  if (rest.empty() || !torn_.empty()) return std::nullopt;
  std::string_view why;
  const auto event = ParseEvent(rest, why);
  if (!event) {
    torn_ = fmt::format("{} after event {} (byte {}); {} bytes after it are ignored", why,
                        events_ - 1, offset_, rest.size());
    return std::nullopt;
  }
  offset_ += SizeInFile(*event);
  ++events_;
  return event;
}

}  // namespace fogline::log
