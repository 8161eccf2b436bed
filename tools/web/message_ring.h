// The newest messages of a network, for clients that open late and for clients of different speed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "services/runtime/wire/wire.h"

namespace fogline::web {

/// A message as it stands in the ring, and in frames of kind 1.
struct RingMessage {
  std::uint16_t channel = 0;
  double wall_ms = 0;  // wall clock of its arrival, since 1970
  runtime::Bytes bytes;
};

/// A stream of messages of which the oldest ones are dropped. All clients read the same bytes, each
/// at its own place. So the memory does not depend on the number of clients, and a message is
/// encoded once.
class MessageRing {
 public:
  static constexpr std::size_t kMostBytes = 64 << 20;
  static constexpr double kMost_ms = 60'000;  // from the oldest to the newest message, about
  static constexpr std::size_t kChunkBytes = 64 << 10;

  void Add(const RingMessage& message);

  /// The place of the oldest message, and the place behind the newest one. Places are numbers of
  /// bytes since the first message. They never go back.
  std::uint64_t begin() const { return chunks_.empty() ? end_ : chunks_.front().begin; }
  std::uint64_t end() const { return end_; }

  /// Whole messages from `place` on, at most about kChunkBytes: for each u16 channel, f64 wall_ms,
  /// u32 size (little endian), and the bytes. Valid until the next Add(). "" at the end.
  /// @pre begin() <= place, and place is the beginning of a message or the end
  std::string_view From(std::uint64_t place) const;

 private:
  struct Chunk {
    std::uint64_t begin = 0;
    double newest_ms = 0;
    std::string bytes;
  };

  /// Drops old messages, and those whose place a new chunk needs.
  void Trim(double now_ms, std::size_t room);

  std::deque<Chunk> chunks_;
  std::uint64_t end_ = 0;
};

/// Adds a message to a text of messages, as From() gives it.
void AddRingMessage(const RingMessage& message, std::string& messages);

/// Removes the first message from a text that From() has returned. @pre the text is not empty
RingMessage TakeRingMessage(std::string_view& messages);

}  // namespace fogline::web
