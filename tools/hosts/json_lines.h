// Messages between a runner and `fogline host` on another machine: each is a JSON object on a line
// of its own.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "common/clock.h"

namespace fogline::hosts {

/// Thrown for a line that is no JSON object, or is too long.
class NotUnderstood : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Sends and receives. Neither waits for the other side, so a side that is stopped or cut off does
/// not hold this process up.
class JsonLines {
 public:
  /// The longest line, in bytes. A report about a process that has ended has 10 lines of at most
  /// 4 KiB, which JSON may make six times as long.
  static constexpr std::size_t kMaxLine = std::size_t{1} << 18U;

  /// @param input, output files for reading and writing; they may be the same socket. They are not
  ///     closed. Writing to `output` does not wait from now on.
  JsonLines(int input, int output);

  /// Sends a message, or the part of it for which there is room. The rest is sent with the next
  /// message or by Wait().
  void Send(const nlohmann::json& message);
  /// Waits until something can be read, but no longer than `limit`. Sends what has waited for room.
  void Wait(Duration limit);
  /// The next message; nullopt if none has come. Does not wait.
  /// @throws NotUnderstood
  std::optional<nlohmann::json> Take();
  /// The next line; nullopt if none has come. @throws NotUnderstood if a line is too long
  std::optional<std::string> TakeLine();
  /// Whether the other side has closed the connection, and everything that came was taken.
  bool ended() const { return ended_ && received_.find('\n') == std::string::npos; }

 private:
  void Flush();
  void Read();

  int input_;
  int output_;
  std::string to_send_;
  std::string received_;
  bool ended_ = false;
};

}  // namespace fogline::hosts
