#include "services/recorder/event_log.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fmt/core.h>

#include "scenario/loader.h"

namespace fogline {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
constexpr std::size_t kEventHeader = 28;
constexpr std::size_t kMaxChannel = 63;  // LCM_MAX_CHANNEL_NAME_LENGTH

std::uint32_t ReadUint32(Bytes bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = (value << 8) | bytes[offset + i];
  return value;
}

template <class Unsigned>
void AppendBigEndian(Unsigned value, std::vector<std::uint8_t>& bytes) {
  constexpr int kByteBits = 8;
  for (int shift = kByteBits * (sizeof(value) - 1); shift >= 0; shift -= kByteBits) {
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

}  // namespace

EventLogWriter::EventLogWriter(const std::filesystem::path& file)
    : file_(file), out_(std::fopen(file.c_str(), "wb")) {
  if (out_ == nullptr) {
    throw InputError(
        fmt::format("{}: error: cannot write the log: {}", file.string(), std::strerror(errno)));
  }
}

EventLogWriter::~EventLogWriter() { std::fclose(out_); }

void EventLogWriter::Write(std::string_view channel, std::int64_t utime, Bytes data) {
  event_.clear();
  AppendBigEndian(kSyncWord, event_);
  AppendBigEndian(static_cast<std::uint64_t>(events_++), event_);
  AppendBigEndian(static_cast<std::uint64_t>(utime), event_);
  AppendBigEndian(static_cast<std::uint32_t>(channel.size()), event_);
  AppendBigEndian(static_cast<std::uint32_t>(data.size()), event_);
  event_.insert(event_.end(), channel.begin(), channel.end());
  event_.insert(event_.end(), data.begin(), data.end());
  if (std::fwrite(event_.data(), 1, event_.size(), out_) != event_.size()) FailToWrite();
}

void EventLogWriter::Flush() {
  if (std::fflush(out_) != 0) FailToWrite();
}

void EventLogWriter::FailToWrite() const {
  throw std::runtime_error(
      fmt::format("cannot write to {}: {}", file_.string(), std::strerror(errno)));
}

EventLogReader::EventLogReader(const std::filesystem::path& file) {
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat info {};
  if (fd < 0 || fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) {
    const std::string why = fd >= 0 ? "not a regular file" : std::strerror(errno);
    if (fd >= 0) close(fd);
    throw InputError(fmt::format("{}: error: cannot read the log: {}", file.string(), why));
  }
  const auto size = static_cast<std::size_t>(info.st_size);
  void* mapped = size == 0 ? nullptr : mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
  close(fd);
  if (mapped == MAP_FAILED) {
    throw InputError(
        fmt::format("{}: error: cannot map the log: {}", file.string(), std::strerror(errno)));
  }
  if (mapped != nullptr) madvise(mapped, size, MADV_SEQUENTIAL);
  content_ = {static_cast<const std::uint8_t*>(mapped), size};
  if (size > 0 && (size < 4 || ReadUint32(content_, 0) != kSyncWord)) {
    munmap(mapped, size);
    throw InputError(fmt::format("{}: error: not an LCM event log", file.string()));
  }
}

EventLogReader::~EventLogReader() {
  if (!content_.empty()) {
    munmap(const_cast<std::uint8_t*>(content_.data()), content_.size());
  }
}

std::optional<Event> EventLogReader::Next() {
  const Bytes rest = content_.subspan(offset_);
  if (rest.empty() || !torn_.empty()) return std::nullopt;
  const auto tear = [&](std::string_view what) {
    torn_ = fmt::format("{} after event {} (byte {}); {} bytes behind it are ignored", what,
                        events_ - 1, offset_, rest.size());
    return std::nullopt;
  };
  if (rest.size() < kEventHeader) return tear("cut off");
  if (ReadUint32(rest, 0) != kSyncWord) return tear("no event");
  const std::size_t channel_size = ReadUint32(rest, 20);
  const std::size_t data_size = ReadUint32(rest, 24);
  if (channel_size == 0 || channel_size > kMaxChannel) return tear("impossible channel name");
  if (channel_size + data_size > rest.size() - kEventHeader) return tear("cut off");
  const auto* channel = reinterpret_cast<const char*>(rest.data() + kEventHeader);
  offset_ += kEventHeader + channel_size + data_size;
  ++events_;
  return Event{.number = ReadInt64(rest, 4),
               .utime = ReadInt64(rest, 12),
               .channel = {channel, channel_size},
               .data = rest.subspan(kEventHeader + channel_size, data_size)};
}

}  // namespace fogline
