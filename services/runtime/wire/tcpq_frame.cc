#include "services/runtime/wire/tcpq_frame.h"

#include <utility>

#include <fmt/core.h>

#include "common/text.h"

namespace fogline::runtime::tcpq {
namespace {

constexpr std::size_t kWord = 4;

std::size_t WordAt(Bytes bytes, std::size_t offset) {
  std::uint32_t word = 0;
  for (const std::uint8_t byte : bytes.subspan(offset, kWord)) word = (word << 8) | byte;
  return word;
}

void AppendWord(std::size_t word, std::vector<std::uint8_t>& out) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(word >> shift));
}

}  // namespace

void FrameParser::Append(Bytes bytes) {
  if (!error_.empty()) return;
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(begin_));
  begin_ = 0;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

bool FrameParser::Greeted() {
  const Bytes rest = Rest();
  if (greeted_ || !error_.empty() || rest.size() < kWord) return greeted_;
  if (const std::size_t magic = WordAt(rest, 0); magic != magic_) {
    Refuse(fmt::format("begins with {:#010x}, not with tcpq's {:#010x}", magic, magic_));
    return false;
  }
  if (rest.size() < 2 * kWord) return false;
  if (const std::size_t version = WordAt(rest, kWord); version != kVersion) {
    Refuse(fmt::format("speaks version {:#06x} of tcpq, not {:#06x}", version, kVersion));
    return false;
  }
  begin_ += 2 * kWord;
  greeted_ = true;
  return true;
}

std::optional<Frame> FrameParser::Next() {
  if (!Greeted() || !error_.empty()) return std::nullopt;
  const Bytes rest = Rest();
  if (rest.size() < kWord) return std::nullopt;
  const auto type = static_cast<FrameType>(WordAt(rest, 0));
  const bool publish = type == FrameType::kPublish;
  if (!publish && type != FrameType::kSubscribe && type != FrameType::kUnsubscribe) {
    return Refuse(fmt::format("frame of unknown type {}", WordAt(rest, 0)));
  }
  if (rest.size() < 2 * kWord) return std::nullopt;
  const std::size_t name_bytes = WordAt(rest, kWord);
  const std::size_t name_limit = publish ? limits_.channel : limits_.pattern;
  if (name_bytes > name_limit) {
    return Refuse(fmt::format("{} of {} bytes; at most {}", publish ? "channel name" : "pattern",
                              name_bytes, name_limit));
  }
  std::size_t end = 2 * kWord + name_bytes;
  if (rest.size() < end) return std::nullopt;
  const Bytes name = rest.subspan(2 * kWord, name_bytes);
  Frame frame{.type = type,
              .name = {reinterpret_cast<const char*>(name.data()), name.size()},
              .payload = {},
              .wire = {}};
  if (frame.name.find('\0') != std::string_view::npos) {
    return Refuse(fmt::format("a zero byte in \"{}\"", Printable(frame.name)));
  }
  if (publish) {
    if (rest.size() < end + kWord) return std::nullopt;
    const std::size_t payload_bytes = WordAt(rest, end);
    if (payload_bytes > limits_.payload) {
      return Refuse(fmt::format("message of {} bytes on \"{}\"; at most {}", payload_bytes,
                                Printable(frame.name), limits_.payload));
    }
    end += kWord + payload_bytes;
    if (rest.size() < end) return std::nullopt;
    frame.payload = rest.subspan(end - payload_bytes, payload_bytes);
  }
  frame.wire = rest.first(end);
  begin_ += end;
  return frame;
}

std::nullopt_t FrameParser::Refuse(std::string error) {
  error_ = std::move(error);
  buffer_.clear();
  buffer_.shrink_to_fit();
  begin_ = 0;
  return std::nullopt;
}

void AppendHello(std::uint32_t magic, std::vector<std::uint8_t>& out) {
  AppendWord(magic, out);
  AppendWord(kVersion, out);
}

void AppendFrame(FrameType type, std::string_view name, Bytes payload,
                 std::vector<std::uint8_t>& out) {
  AppendWord(static_cast<std::size_t>(type), out);
  AppendWord(name.size(), out);
  out.insert(out.end(), name.begin(), name.end());
  if (type != FrameType::kPublish) return;
  AppendWord(payload.size(), out);
  out.insert(out.end(), payload.begin(), payload.end());
}

}  // namespace fogline::runtime::tcpq
