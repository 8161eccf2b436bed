#include "tools/fogline/relay_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include <fmt/core.h>

#include "scenario/file.h"
#include "services/runtime/clock.h"
#include "tools/fogline/child.h"

namespace fogline {
namespace {

constexpr Duration kListenLimit = milliseconds(5000);

/// It names on our stderr whom it disconnects.
[[noreturn]] void Become(const char* program, int output, pid_t parent) {
  BecomeChild(parent, output);
  execl(program, program, "--listen", "127.0.0.1:0", "--quiet", nullptr);
  _exit(127);
}

/// The line that it prints when it listens; "" if it does not.
std::string FirstLine(int output) {
  std::string text;
  const TimePoint end = Clock::now() + kListenLimit;
  std::array<char, 256> buffer{};
  while (text.find('\n') == std::string::npos) {
    pollfd waited{.fd = output, .events = POLLIN, .revents = 0};
    const auto left = Milliseconds(end - Clock::now());
    if (left <= 0) return "";
    if (poll(&waited, 1, static_cast<int>(left)) <= 0) continue;
    const ssize_t size = read(output, buffer.data(), buffer.size());
    if (size <= 0) return "";
    text.append(buffer.data(), static_cast<std::size_t>(size));
  }
  return text.substr(0, text.find('\n'));
}

}  // namespace

RelayProcess::RelayProcess() {
  const std::string program = ProgramBeside("fogline-relay").string();
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    ThrowIfExhausted(errno, "cannot make a pipe");
    throw std::runtime_error(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  }
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) Become(program.c_str(), ends[1], parent);
  close(ends[1]);
  if (pid_ > 0) url_ = FirstLine(ends[0]);
  close(ends[0]);
  if (!url_.empty()) return;
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  throw std::runtime_error(fmt::format("cannot start {}", program));
}

RelayProcess::~RelayProcess() {
  kill(pid_, SIGKILL);  // it keeps nothing
  waitpid(pid_, nullptr, 0);
}

}  // namespace fogline
