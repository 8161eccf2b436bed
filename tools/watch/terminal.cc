#include "tools/watch/terminal.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <string>

#include <fmt/core.h>

namespace fogline::watch {
namespace {

constexpr const char* kEnter = "\033[?1049h\033[?25l";  // alternate screen, no cursor
constexpr const char* kLeave = "\033[?25h\033[?1049l";
constexpr const char* kHome = "\033[H";
constexpr const char* kClearLine = "\033[K";
constexpr const char* kClearBelow = "\033[J";
constexpr const char* kBold = "\033[1m";
constexpr const char* kRed = "\033[31m";
constexpr const char* kReverse = "\033[7m";
constexpr const char* kNormal = "\033[0m";

const char* StyleOf(Line::Style style) {
  switch (style) {
    case Line::Style::kHeading:
      return kBold;
    case Line::Style::kBad:
      return kRed;
    case Line::Style::kSelected:
      return kReverse;
    case Line::Style::kPlain:
      break;
  }
  return "";
}

}  // namespace

Terminal::Terminal() {
  if (isatty(STDIN_FILENO) == 1 && tcgetattr(STDIN_FILENO, &before_) == 0) {
    fd_ = STDIN_FILENO;
    has_keys_ = true;
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    keys.c_cc[VSUSP] = _POSIX_VDISABLE;  // no Ctrl-Z: after it, the shell would have no echo
    tcsetattr(fd_, TCSANOW, &keys);
  }
  Write(kEnter);
}

Terminal::~Terminal() {
  Write(kLeave);
  if (fd_ >= 0) tcsetattr(fd_, TCSANOW, &before_);
}

Terminal::Size Terminal::size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) {
    return {};
  }
  return {.columns = size.ws_col, .rows = size.ws_row};
}

void Terminal::Draw(const std::vector<Line>& lines) {
  std::string text = kHome;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& line = lines[i];
    const char* style = StyleOf(line.style);
    text += fmt::format("{}{}{}{}{}", i == 0 ? "" : "\r\n", style, line.text,
                        *style == '\0' ? "" : kNormal, kClearLine);
  }
  Write(text + kClearBelow);
}

std::optional<Key> Terminal::NextKey() {
  const bool read = Read();
  return keys_.Next(!read);
}

bool Terminal::Read() {
  pollfd keys{.fd = fd_, .events = POLLIN, .revents = 0};
  if (!has_keys_ || poll(&keys, 1, 0) <= 0) return false;
  std::array<char, 64> bytes{};
  const ssize_t size = read(fd_, bytes.data(), bytes.size());
  if (size > 0) {
    keys_.Take({bytes.data(), static_cast<std::size_t>(size)});
    return true;
  }
  // After the end of stdin, poll() reports stdin as readable forever. So fd() must then return -1.
  if (size == 0 || (errno != EINTR && errno != EAGAIN)) has_keys_ = false;
  return false;
}

void Terminal::Write(const std::string& text) {
  gone_ = std::fputs(text.c_str(), stdout) == EOF || std::fflush(stdout) != 0;
}

}  // namespace fogline::watch
