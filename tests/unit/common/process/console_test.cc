#include "common/process/console.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fogline {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

/// The ends of a pipe or a socket pair: bytes that are written to `in` come out of `out`.
struct Ends {
  int out;
  int in;
};

Ends Pipe() {
  std::array<int, 2> ends{};
  EXPECT_EQ(pipe(ends.data()), 0);
  return {ends[0], ends[1]};
}

Ends Sockets() {
  std::array<int, 2> ends{};
  EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
  return {ends[0], ends[1]};
}

/// Reads the bytes that are available, without waiting for more.
std::string Read(int fd) {
  fcntl(fd, F_SETFL, O_NONBLOCK);
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t size = 0; (size = read(fd, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(size));
  }
  return text;
}

/// Calls `run` in a child process whose stderr is `standard_error`. Each call needs a new process,
/// because the functions of console.h examine stderr only once in a process. @return the exit code
/// of the child
int InChild(int standard_error, const std::function<int()>& run) {
  const pid_t child = fork();
  if (child == 0) {
    dup2(standard_error, STDERR_FILENO);
    alarm(30);  // ends a process that waits for a reader
    _exit(run());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

class ConsoleTest : public testing::TestWithParam<Ends (*)()> {};

TEST_P(ConsoleTest, NoticesAreDroppedWhereThereIsNoRoomAndTheNextOneSaysSo) {
  const Ends ends = GetParam()();
  const int code = InChild(ends.in, [&] {
    const std::string long_line(1000, 'x');
    for (int i = 0; i < 1000; ++i) Notice(long_line);  // more than the pipe holds
    Read(ends.out);                                    // now there is room
    Notice("the end");
    return 0;
  });
  EXPECT_EQ(code, 0);
  const std::string rest = Read(ends.out);
  EXPECT_THAT(rest, HasSubstr(" lines are missing here\n"));
  EXPECT_THAT(rest, EndsWith("\nthe end\n"));
}

TEST_P(ConsoleTest, AComplaintWaitsForAReaderThatIsSlow) {
  const Ends ends = GetParam()();
  // GIVEN a reader that begins only when the pipe is full
  const std::string line(1000, 'x');
  constexpr std::size_t kLines = 1000;
  const pid_t writer = fork();
  if (writer == 0) {
    dup2(ends.in, STDERR_FILENO);
    for (std::size_t i = 0; i < kLines; ++i) Complain(line);
    _exit(0);
  }
  close(ends.in);
  std::string text;
  std::array<char, 1 << 16> buffer{};
  for (ssize_t size = 0; (size = read(ends.out, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(size));
  }
  waitpid(writer, nullptr, 0);
  // THEN the reader gets every line completely
  EXPECT_EQ(text.size(), kLines * (line.size() + 1));
  EXPECT_THAT(text, Not(HasSubstr("missing")));
}

TEST_P(ConsoleTest, AComplaintWaitsForAReaderAlsoWhenNoticesWereDropped) {
  const Ends ends = GetParam()();
  const Ends told = Pipe();
  const pid_t writer = fork();
  if (writer == 0) {
    dup2(ends.in, STDERR_FILENO);
    const std::string long_line(1000, 'x');
    for (int i = 0; i < 1000; ++i) Notice(long_line);  // more than the pipe holds
    const char byte = 0;
    if (write(told.in, &byte, 1) != 1) _exit(1);
    Complain(long_line + " the error");
    _exit(0);
  }
  close(ends.in);
  // GIVEN a reader that begins to read some time after the writer filled the pipe
  char byte = 0;
  ASSERT_EQ(read(told.out, &byte, 1), 1);
  usleep(200'000);
  std::string text;
  std::array<char, 1 << 16> buffer{};
  for (ssize_t size = 0; (size = read(ends.out, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(size));
  }
  waitpid(writer, nullptr, 0);
  EXPECT_THAT(text, HasSubstr(" lines are missing here\n"));
  EXPECT_THAT(text.substr(std::max<std::size_t>(text.size(), 20) - 20), EndsWith(" the error\n"));
}

TEST_P(ConsoleTest, NothingIsChangedForOtherProcessesThatHaveTheSameDescription) {
  const Ends ends = GetParam()();
  InChild(ends.in, [] {
    Notice("a line");
    return 0;
  });
  EXPECT_EQ(fcntl(ends.in, F_GETFL) & O_NONBLOCK, 0);
  EXPECT_EQ(Read(ends.out), "a line\n");
}

TEST_P(ConsoleTest, ALineWithoutAReaderEndsNoProcess) {
  const Ends ends = GetParam()();
  close(ends.out);
  EXPECT_EQ(InChild(ends.in,
                    [] {
                      Notice("a line");
                      Complain("another");
                      Draw("a bar");
                      return 7;
                    }),
            7);
}

INSTANTIATE_TEST_SUITE_P(To, ConsoleTest, testing::Values(Pipe, Sockets),
                         [](const auto& ends) { return ends.index == 0 ? "Pipe" : "Socket"; });

/// Prints a line from a background process of a terminal with `stty tostop`. Such a terminal stops
/// background processes that write.
/// @return the status of the process that prints the line, as waitpid() gives it
int StatusInBackground(const char* terminal) {
  setsid();
  const int own = open(terminal, O_RDWR);  // the controlling terminal, see setsid(2)
  termios settings{};
  tcgetattr(own, &settings);
  settings.c_lflag |= TOSTOP;
  tcsetattr(own, TCSANOW, &settings);
  const pid_t background = fork();
  if (background == 0) {
    setpgid(0, 0);
    dup2(own, STDERR_FILENO);
    Notice("a line");
    _exit(7);
  }
  int status = 0;
  waitpid(background, &status, WUNTRACED);
  if (WIFSTOPPED(status)) kill(background, SIGKILL);
  return status;
}

TEST(ConsoleTerminalTest, AProcessInTheBackgroundIsNotStopped) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(grantpt(terminal) + unlockpt(terminal), 0);
  const pid_t leader = fork();
  if (leader == 0) {
    alarm(30);
    const int status = StatusInBackground(ptsname(terminal));
    _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
  }
  int status = 0;
  waitpid(leader, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_THAT(Read(terminal), HasSubstr("a line"));
  close(terminal);
}

TEST(ConsoleTextTest, WhatATerminalWouldObeyIsEscaped) {
  const Ends ends = Pipe();
  InChild(ends.in, [] {
    Notice("\x1b[31mred\xe2\x80\xae\nsecond line");
    Draw("\r\x1b[K");  // this escape sequence is Fogline's own
    return 0;
  });
  EXPECT_EQ(Read(ends.out), "\\u001b[31mred\\u202e\nsecond line\n\r\x1b[K");
}

TEST(StandardDescriptorsTest, DescriptorsThatAreClosedAreTakenAndCannotBeUsed) {
  const Ends ends = Pipe();
  const int code = InChild(ends.in, [] {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) close(descriptor);
    TakeStandardDescriptors();
    const int next = open("/dev/null", O_RDWR);
    char byte = 0;
    const bool usable = read(STDIN_FILENO, &byte, 1) >= 0 || write(STDOUT_FILENO, &byte, 1) >= 0 ||
                        write(STDERR_FILENO, &byte, 1) >= 0;
    return next > STDERR_FILENO && !usable ? 0 : 1;
  });
  EXPECT_EQ(code, 0);
}

}  // namespace
}  // namespace fogline
