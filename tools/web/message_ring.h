// The newest messages of a network, for clients that connect late, and for clients that read at
// different speeds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "services/runtime/wire/wire.h"

namespace fogline::web {

/// A message in the ring. Each message in a frame of kind 1 (docs/view.md) has the same members.
struct RingMessage {
  std::uint16_t channel = 0;
  double wall_ms = 0;  // wall clock of its arrival, in ms since 1970
  runtime::Bytes bytes;
};

/// A stream of messages whose oldest messages are dropped. All clients read the same bytes, each
/// client at its own place. So the memory does not depend on the number of clients, and each
/// message is encoded once.
class MessageRing {
 public:
  static constexpr std::size_t kMostBytes = 64 << 20;
  static constexpr double kMost_ms = 60'000;  // approximate limit for the age of a message
  static constexpr std::size_t kChunkBytes = 64 << 10;

  void Add(const RingMessage& message);

  /// The place of the oldest message, and the place after the newest message. A place is a number
  /// of bytes since the first message. Places never decrease.
  std::uint64_t begin() const { return chunks_.empty() ? end_ : chunks_.front().begin; }
  std::uint64_t end() const { return end_; }

  /// Complete messages from `place` on, together at most about kChunkBytes. Each message has: u16
  /// channel, f64 wall_ms, u32 size (little endian), and the bytes. The result is "" if `place` is
  /// the end. It is valid until the next Add().
  /// @pre begin() <= place, and place is the beginning of a message or the end
  std::string_view From(std::uint64_t place) const;

 private:
  struct Chunk {
    std::uint64_t begin = 0;
    double newest_ms = 0;
    std::string bytes;
  };

  /// Drops messages that are too old. Also drops the oldest messages until a new chunk of `room`
  /// bytes fits into kMostBytes.
  void Trim(double now_ms, std::size_t room);

  std::deque<Chunk> chunks_;
  std::uint64_t end_ = 0;
};

/// Appends a message to `messages`, in the form that From() describes.
void AddRingMessage(const RingMessage& message, std::string& messages);

/// Removes the first message from a text that From() has returned. @pre the text is not empty
RingMessage TakeRingMessage(std::string_view& messages);

}  // namespace fogline::web
