// The frames of LCM's tcpq protocol. FrameParser cuts a received byte stream into frames;
// AppendFrame() writes a frame. This file uses no socket.
//
// All words are 32 bits, big endian. Each side begins with two words: its magic and the version.
// Then frames follow:
//   PUBLISH      1, length, channel, length, payload
//   SUBSCRIBE    2, length, regular expression
//   UNSUBSCRIBE  3, length, regular expression
// A relay sends only PUBLISH frames, with the same bytes that it has received. Source: lcm_tcpq.c
// and TCPService.java of LCM 1.3.1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/runtime/wire/wire.h"

namespace fogline::runtime::tcpq {

inline constexpr std::uint32_t kRelayMagic = 0x287617fa;
inline constexpr std::uint32_t kClientMagic = 0x287617fb;
inline constexpr std::uint32_t kVersion = 0x0100;

enum class FrameType : std::uint32_t { kPublish = 1, kSubscribe = 2, kUnsubscribe = 3 };

/// The largest parts of a frame, in bytes. A longer part is refused before it is read.
struct Limits {
  std::size_t channel = kLongestChannel;
  // The cost of matching a channel with a pattern grows with the square of the pattern's length, so
  // patterns must be short.
  std::size_t pattern = 256;
  std::size_t payload = 4 << 20;
};

/// A frame; its views are valid until the parser's next Append().
struct Frame {
  FrameType type;
  std::string_view name;  // channel, or regular expression
  Bytes payload;          // only for PUBLISH
  Bytes wire;             // the whole frame as received
};

/// Cuts a byte stream into frames. If the caller takes all frames after every Append(), the parser
/// stores at most the bytes of one frame and of the last Append().
class FrameParser {
 public:
  /// @param magic the word that the other side must begin with
  FrameParser(std::uint32_t magic, const Limits& limits) : magic_(magic), limits_(limits) {}

  /// Adds received bytes, in pieces of any size.
  void Append(Bytes bytes);

  /// Whether the other side has sent its first two words.
  bool Greeted();

  /// The next whole frame; nullopt if more bytes are needed, or if error() says what is wrong.
  std::optional<Frame> Next();

  /// Why the stream is not tcpq; "" if no error is known. An error is final.
  const std::string& error() const { return error_; }

 private:
  Bytes Rest() const { return Bytes(buffer_).subspan(begin_); }
  std::nullopt_t Refuse(std::string error);

  std::uint32_t magic_;
  Limits limits_;
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0;  // index of the first byte that is not parsed yet
  bool greeted_ = false;
  std::string error_;
};

/// Adds the two words with which a side begins: its magic and the version.
void AppendHello(std::uint32_t magic, std::vector<std::uint8_t>& out);
/// Adds a frame. `payload` is used only for PUBLISH.
void AppendFrame(FrameType type, std::string_view name, Bytes payload,
                 std::vector<std::uint8_t>& out);

}  // namespace fogline::runtime::tcpq
