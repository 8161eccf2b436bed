// A program in a terminal of its own. The test types at this terminal.
#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "common/clock.h"
#include "common/process/poll.h"
#include "tests/support/command.h"

namespace fogline::test {

/// A program in the foreground of a terminal of its own. The first word of the command is the path
/// of the program.
class InTerminal {
 public:
  explicit InTerminal(const std::vector<std::string>& command) {
    std::vector<char*> argv;
    for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const std::string folder = SourceDirectory().string();
    // Reads the attributes of the terminal before the program can change them.
    int of_program = -1;
    if (openpty(&terminal_, &of_program, nullptr, nullptr, nullptr) != 0) std::abort();
    tcgetattr(terminal_, &before_);
    pid_ = fork();
    if (pid_ == 0) {
      close(terminal_);
      if (login_tty(of_program) != 0) _exit(127);
      if (chdir(folder.c_str()) == 0) execv(argv[0], argv.data());
      _exit(127);
    }
    close(of_program);
  }
  ~InTerminal() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(terminal_);
  }
  InTerminal(const InTerminal&) = delete;
  InTerminal& operator=(const InTerminal&) = delete;

  void Type(const std::string& characters) {
    ASSERT_EQ(write(terminal_, characters.data(), characters.size()),
              static_cast<ssize_t>(characters.size()));
  }
  /// Whether the terminal passes on each key at once and does not show it.
  bool IsRaw() const {
    termios now{};
    tcgetattr(terminal_, &now);
    return (now.c_lflag & (ICANON | ECHO)) == 0;
  }
  bool IsAsBefore() const {
    termios now{};
    tcgetattr(terminal_, &now);
    return now.c_lflag == before_.c_lflag && now.c_iflag == before_.c_iflag &&
           now.c_oflag == before_.c_oflag &&
           std::equal(std::begin(now.c_cc), std::end(now.c_cc), std::begin(before_.c_cc));
  }
  /// Reads what the program prints until a condition holds. @return false after the time limit
  template <class Condition>
  bool WaitUntil(const Condition& holds) {
    const TimePoint end = Clock::now() + kPatience;
    while (!holds()) {
      if (Clock::now() > end) return false;
      Read(milliseconds(20));
    }
    return true;
  }
  /// @return the exit code; -1 after the time limit
  int Wait() {
    const TimePoint end = Clock::now() + kPatience;
    int status = 0;
    while (waitpid(pid_, &status, WNOHANG) == 0) {
      if (Clock::now() > end) return -1;
      Read(milliseconds(20));
    }
    pid_ = -1;
    Read(milliseconds(20));
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  pid_t pid() const { return pid_; }
  const std::string& text() const { return text_; }

 private:
  void Read(Duration limit) {
    std::array<char, 4096> buffer{};
    if (PollFor(terminal_, POLLIN, limit) <= 0) return;
    const ssize_t size = read(terminal_, buffer.data(), buffer.size());
    if (size > 0) text_.append(buffer.data(), static_cast<std::size_t>(size));
  }

  int terminal_ = -1;
  pid_t pid_ = -1;
  termios before_{};
  std::string text_;
};

}  // namespace fogline::test
