#include "tools/hosts/json_lines.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include <fmt/core.h>

#include "common/process/poll.h"
#include "common/text.h"

namespace fogline::hosts {
namespace {

/// Writes to a socket or a pipe. Writing to a socket that no process reads raises no SIGPIPE.
ssize_t Write(int file, const std::string& text) {
  const ssize_t sent = send(file, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent < 0 && errno == ENOTSOCK ? write(file, text.data(), text.size()) : sent;
}

}  // namespace

JsonLines::JsonLines(int input, int output) : input_(input), output_(output) {
  fcntl(output_, F_SETFL, fcntl(output_, F_GETFL) | O_NONBLOCK);
}

void JsonLines::Send(const nlohmann::json& message) {
  // Bytes that are not UTF-8 become U+FFFD, because a program may print any bytes.
  to_send_ += message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  Flush();
}

void JsonLines::Flush() {
  while (!to_send_.empty()) {
    const ssize_t sent = Write(output_, to_send_);
    if (sent > 0) {
      to_send_.erase(0, static_cast<std::size_t>(sent));
    } else if (sent == 0 || errno == EAGAIN || errno == EWOULDBLOCK) {
      return;
    } else if (errno != EINTR) {  // no process reads; Read() will find the end
      to_send_.clear();
    }
  }
}

void JsonLines::Wait(Duration limit) {
  Flush();
  if (!ended_ && PollFor(input_, POLLIN, limit) > 0) Read();
}

void JsonLines::Read() {
  std::array<char, 4096> buffer{};
  const ssize_t size = read(input_, buffer.data(), buffer.size());
  if (size > 0) {
    received_.append(buffer.data(), static_cast<std::size_t>(size));
  } else if (size == 0 || (errno != EINTR && errno != EAGAIN)) {
    ended_ = true;
  }
}

std::optional<std::string> JsonLines::TakeLine() {
  Flush();
  std::size_t end = received_.find('\n');
  while (end == std::string::npos && received_.size() <= kMaxLine && !ended_ &&
         PollFor(input_, POLLIN, Duration::zero()) > 0) {
    Read();
    end = received_.find('\n');
  }
  // The bytes of a line that is too long may come from Wait(). So the length is checked even if
  // this function has read nothing.
  if (std::min(end, received_.size()) > kMaxLine) {
    throw NotUnderstood(fmt::format("a line has more than {} bytes", kMaxLine));
  }
  if (end == std::string::npos) return std::nullopt;
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  return line;
}

std::optional<nlohmann::json> JsonLines::Take() {
  const auto line = TakeLine();
  if (!line) return std::nullopt;
  auto message = nlohmann::json::parse(*line, nullptr, false);
  if (!message.is_object()) throw NotUnderstood("not a JSON object: " + QuoteShort(*line));
  return message;
}

}  // namespace fogline::hosts
