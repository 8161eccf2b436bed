// Passes messages from the thread that receives them to the thread that writes them. The queue has
// no limit, so a slow disk loses no message as long as there is memory.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "common/clock.h"
#include "services/log/event_log.h"
#include "tools/record/message_assembler.h"

namespace fogline::record {

class MessageQueue {
 public:
  /// Successive events in the format of a log. The number of each event is 0, because the writer of
  /// the log numbers the events.
  using Chunk = std::vector<std::uint8_t>;

  /// Adds a message. Called by the thread that receives.
  void Put(const Message& message) {
    {
      const std::lock_guard lock(mutex_);
      if (chunks_.empty() || chunks_.back().size() >= kChunk) chunks_.emplace_back();
      Chunk& chunk = chunks_.back();
      const std::size_t before = chunk.size();
      log::AppendEvent(0, message.channel, message.unix_us, message.data, chunk);
      waiting_ += static_cast<std::int64_t>(chunk.size() - before);
      most_waiting_ = std::max(most_waiting_, waiting_);
    }
    filled_.notify_one();
  }
  /// Says that no more messages will come. Called by the thread that receives.
  void Close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    filled_.notify_one();
  }

  /// Called by the thread that writes. Waits for messages, but no longer than `until`.
  /// @return all messages in the queue, which is empty afterwards
  std::vector<Chunk> Take(TimePoint until) {
    std::unique_lock lock(mutex_);
    filled_.wait_until(lock, until, [this] { return closed_ || !chunks_.empty(); });
    waiting_ = 0;
    return std::exchange(chunks_, {});
  }
  /// Whether the queue is closed, and Take() has nothing left to return.
  bool Over() {
    const std::lock_guard lock(mutex_);
    return closed_ && chunks_.empty();
  }

  /// The largest number of bytes that have waited at the same time.
  std::int64_t most_waiting() {
    const std::lock_guard lock(mutex_);
    return most_waiting_;
  }

 private:
  static constexpr std::size_t kChunk = 1 << 20;

  std::mutex mutex_;
  std::condition_variable filled_;
  std::vector<Chunk> chunks_;
  std::int64_t waiting_ = 0;
  std::int64_t most_waiting_ = 0;
  bool closed_ = false;
};

}  // namespace fogline::record
