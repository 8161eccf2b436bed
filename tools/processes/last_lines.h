// Keeps the last lines of a program's output, however long the output is.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fogline::processes {

class LastLines {
 public:
  static constexpr std::size_t kKept = 10;
  /// Limit for the stored bytes of a line. Only the beginning of a longer line is stored, because
  /// errors begin with their cause.
  static constexpr std::size_t kMaxBytes = 4096;

  /// Adds output, in pieces of any size.
  void Append(std::string_view text) {
    while (true) {
      const std::size_t end = text.find('\n');
      const std::string_view piece = text.substr(0, end);
      begun_ += piece.substr(0, kMaxBytes - begun_.size());
      if (end == std::string_view::npos) return;
      Finish();
      text.remove_prefix(end + 1);
    }
  }

  /// The lines, including an unfinished last line.
  std::vector<std::string> Take() {
    if (!begun_.empty()) Finish();
    return {lines_.begin(), lines_.end()};
  }

 private:
  void Finish() {
    lines_.push_back(std::move(begun_));
    begun_.clear();
    if (lines_.size() > kKept) lines_.pop_front();
  }

  std::deque<std::string> lines_;
  std::string begun_;
};

}  // namespace fogline::processes
