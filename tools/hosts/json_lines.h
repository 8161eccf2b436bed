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

/// Thrown for a line that is not a JSON object, or is too long.
class NotUnderstood : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Sends and receives messages. Sending never waits for the other process, and receiving waits only
/// in Wait(). So this process goes on if the other process is stopped or cut off.
class JsonLines {
 public:
  /// The longest line, in bytes. A report about a process that has ended has 10 lines of at most
  /// 4 KiB, which JSON may make six times as long.
  static constexpr std::size_t kMaxLine = std::size_t{1} << 18U;

  /// @param input, output file descriptors for reading and for writing. They may be the same
  ///     socket. This class does not close them. It makes writes to `output` non-blocking.
  JsonLines(int input, int output);

  /// Sends a message, or the part of it for which there is room. The remaining part is sent with
  /// the next message or by Wait().
  void Send(const nlohmann::json& message);
  /// Waits until something can be read, but no longer than `limit`. First sends the bytes that
  /// Send() had no room for.
  void Wait(Duration limit);
  /// The next message; nullopt if none has come. Does not wait.
  /// @throws NotUnderstood
  std::optional<nlohmann::json> Take();
  /// The next line; nullopt if none has come. @throws NotUnderstood if a line is too long
  std::optional<std::string> TakeLine();
  /// Whether the other process has closed the connection, and all lines that came were taken.
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
