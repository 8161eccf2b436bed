// Common parts of the tests of fogline view.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/clock.h"
#include "services/graph.h"
#include "services/runtime/wire/wire.h"
#include "tests/support/command.h"
#include "tests/support/web_client.h"
#include "tools/web/types/little_endian.h"

namespace fogline::test {

/// `fogline view` on a free port, without a browser.
class Viewed {
 public:
  explicit Viewed(const std::vector<std::string>& more,
                  const std::vector<std::string>& where = {"--port", "0"})
      : Viewed(Started{Command(more, where)}) {}

  struct Started {
    std::vector<std::string> command;
  };
  /// Starts a command that starts `fogline view`. The first line of its output must be the address
  /// of the view.
  explicit Viewed(const Started& started) : process_(started.command) {
    if (!process_.WaitForOut("\n")) return;
    address_ = process_.Out().substr(0, process_.Out().find('\n'));
    const std::size_t begin = address_.rfind(':') + 1;
    port_ = static_cast<std::uint16_t>(std::stoi(address_.substr(begin)));
  }

  /// The port of the server; 0 if the server does not listen.
  std::uint16_t port() const { return port_; }
  const std::string& address() const { return address_; }
  Background& process() { return process_; }
  /// Ends the program with Ctrl-C, as a person does. @return its exit code
  int End() {
    process_.Signal(SIGINT);
    return process_.Wait();
  }

 private:
  static std::vector<std::string> Command(const std::vector<std::string>& more,
                                          const std::vector<std::string>& where) {
    std::vector<std::string> command{Program("fogline"), "view", "--no-browser"};
    command.insert(command.end(), where.begin(), where.end());
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }

  Background process_;
  std::string address_;
  std::uint16_t port_ = 0;
};

/// Processor time of a process, in seconds (proc(5): utime and stime).
inline double ProcessorTime_s(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  double user = 0;
  double system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// A message in a binary frame.
struct WebMessage {
  std::uint16_t channel = 0;
  double wall_ms = 0;      // only in a frame of kind 1
  std::int64_t step = -1;  // only in a frame of kind 2
  std::string bytes;
};

/// The messages of a frame of kind 1 or 2.
inline std::vector<WebMessage> MessagesOf(const WebFrame& frame) {
  std::vector<WebMessage> messages;
  std::string_view rest = frame.bytes;
  if (!frame.binary || rest.empty()) return messages;
  const char kind = rest.front();
  rest.remove_prefix(1);
  if (kind == 2) web::TakeLittleEndian<std::uint32_t>(rest);  // the id of the request
  while (!rest.empty()) {
    WebMessage message;
    message.channel = web::TakeLittleEndian<std::uint16_t>(rest);
    if (kind == 1) message.wall_ms = web::TakeLittleEndian<double>(rest);
    if (kind == 2) message.step = web::TakeLittleEndian<std::int64_t>(rest);
    const auto size = web::TakeLittleEndian<std::uint32_t>(rest);
    message.bytes = rest.substr(0, size);
    rest.remove_prefix(size);
    messages.push_back(std::move(message));
  }
  return messages;
}

inline char KindOf(const WebFrame& frame) {
  return frame.binary && !frame.bytes.empty() ? frame.bytes.front() : '\0';
}

inline runtime::Bytes BytesOf(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// The server sends several frames per second, so Receive() does not reach its own time limit. A
// test that waits for a certain frame needs this limit.
inline constexpr Duration kFrameLimit = milliseconds(60'000);

/// Waits for a text frame with this "op", and drops other frames. @return the frame. @throws
/// std::runtime_error after kFrameLimit
inline nlohmann::json ReceiveOp(WebClient& client, const std::string& op) {
  const TimePoint end = Clock::now() + kFrameLimit;
  while (true) {
    if (Clock::now() > end) throw std::runtime_error("no frame \"" + op + "\" comes");
    const WebFrame frame = client.Receive();
    if (frame.binary) continue;
    nlohmann::json json = nlohmann::json::parse(frame.bytes);
    if (json["op"] == op) return json;
  }
}

/// Waits for a binary frame of this kind, and drops other frames. @return the frame. @throws
/// std::runtime_error after kFrameLimit
inline WebFrame ReceiveKind(WebClient& client, char kind) {
  const TimePoint end = Clock::now() + kFrameLimit;
  while (true) {
    if (Clock::now() > end) throw std::runtime_error("no frame of the kind comes");
    WebFrame frame = client.Receive();
    if (KindOf(frame) == kind) return frame;
  }
}

/// Reads frames until the server closes the connection. @return the code of the closing frame, 0 if
/// no such frame comes
inline std::uint16_t CloseCodeOf(WebClient& client) {
  try {
    while (true) client.Receive();
  } catch (const WebClosed& closed) {
    return closed.code();
  }
}

}  // namespace fogline::test
