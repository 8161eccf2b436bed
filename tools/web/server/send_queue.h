// The frames that wait to be sent to one client, with a limit for their bytes.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <utility>

namespace fogline::web {

/// A frame for one or several clients. The clients share its bytes.
struct OutgoingFrame {
  std::shared_ptr<const std::string> bytes;
  bool binary = false;
};

inline OutgoingFrame TextFrame(std::string text) {
  return {std::make_shared<const std::string>(std::move(text)), false};
}
inline OutgoingFrame BinaryFrame(std::string bytes) {
  return {std::make_shared<const std::string>(std::move(bytes)), true};
}

/// A first-in, first-out queue. The frame at the front stays in the queue while it is being sent.
class SendQueue {
 public:
  static constexpr std::size_t kMostBytes = 8 << 20;

  /// Adds a frame. An empty queue accepts any frame.
  /// @return false if there is no room; the queue is then unchanged
  [[nodiscard]] bool Push(OutgoingFrame frame) {
    const std::size_t size = frame.bytes->size();
    if (!frames_.empty() && bytes_ + size > kMostBytes) return false;
    bytes_ += size;
    frames_.push_back(std::move(frame));
    return true;
  }
  /// @pre !empty()
  const OutgoingFrame& front() const { return frames_.front(); }
  /// @pre !empty()
  void Pop() {
    bytes_ -= frames_.front().bytes->size();
    frames_.pop_front();
  }
  /// Removes all frames, or all frames except the front one.
  void Clear(bool keep_front) {
    while (frames_.size() > (keep_front ? 1U : 0U)) {
      bytes_ -= frames_.back().bytes->size();
      frames_.pop_back();
    }
  }

  bool empty() const { return frames_.empty(); }
  /// The number of bytes of all frames, including the frame that is being sent.
  std::size_t bytes() const { return bytes_; }

 private:
  std::deque<OutgoingFrame> frames_;
  std::size_t bytes_ = 0;
};

}  // namespace fogline::web
