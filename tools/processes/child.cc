#include "tools/processes/child.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "common/file.h"
#include "common/process/poll.h"
#include "common/process/programs.h"
#include "common/process/shell_word.h"

namespace fogline::processes {
namespace {

/// Turns the child into the program. This function runs between fork and exec, so it makes only
/// async-signal-safe calls. If the program cannot be started, the function writes errno to
/// `failure`.
[[noreturn]] void Become(const char* program, char* const* arguments, int output, int error_output,
                         int input, int failure, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);
  setpgid(0, 0);
  dup2(input >= 0 ? input : open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  if (error_output >= 0) dup2(error_output, STDERR_FILENO);
  // LCM's sockets and pipes lack the close-on-exec flag. A kernel before 5.11 does not know
  // CLOSE_RANGE_CLOEXEC, and leaves these files open in the program.
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  execv(program, arguments);
  const int error = errno;
  [[maybe_unused]] const ssize_t written = write(failure, &error, sizeof(error));
  _exit(127);
}

/// The errno that Become() has written; 0 if the program runs.
int FailureOf(int failure) {
  int error = 0;
  ssize_t size = 0;
  do {
    size = read(failure, &error, sizeof(error));
  } while (size < 0 && errno == EINTR);
  return size == sizeof(error) ? error : 0;
}

}  // namespace

Pipe::Pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    ThrowIfExhausted(errno, "cannot make a pipe");
    throw std::runtime_error(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  }
  read = ends[0];
  write = ends[1];
}

Pipe::~Pipe() {
  for (const int end : {read, write}) {
    if (end >= 0) close(end);
  }
}

pid_t StartChild(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 int output, int error_output, int input) {
  // If SIGCHLD is inherited as ignored, waitpid() cannot report how processes end.
  std::signal(SIGCHLD, SIG_DFL);
  const auto fail = [&program](int error) {
    throw std::runtime_error(
        fmt::format("cannot start {}: {}", program.string(), std::strerror(error)));
  };
  const std::string path = program.string();
  std::vector<char*> argv{const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  Pipe failure;
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) {
    Become(path.c_str(), argv.data(), output, error_output, input, failure.write, parent);
  }
  if (pid < 0) fail(errno);
  close(std::exchange(failure.write, -1));
  if (const int error = FailureOf(failure.read); error != 0) {
    waitpid(pid, nullptr, 0);
    fail(error);
  }
  return pid;
}

bool LineReader::Has(std::size_t count, Duration limit) {
  const TimePoint end = Clock::now() + limit;
  std::array<char, 256> buffer{};
  while (lines_.size() < count && !ended_) {
    const bool is_over = Clock::now() >= end;
    if (PollFor(output_, POLLIN, end - Clock::now()) > 0) {
      const ssize_t size = read(output_, buffer.data(), buffer.size());
      ended_ = size <= 0;
      if (!ended_) Take({buffer.data(), static_cast<std::size_t>(size)});
    } else if (is_over) {  // the pipe is empty
      break;
    }
  }
  return lines_.size() >= count;
}

void LineReader::Take(std::string_view bytes) {
  begun_ += bytes;
  for (std::size_t at = 0; (at = begun_.find('\n')) != std::string::npos; begun_.erase(0, at + 1)) {
    lines_.push_back(begun_.substr(0, at));
  }
}

std::vector<std::string> LinesOf(int output, std::size_t count, Duration limit) {
  LineReader reader(output);
  reader.Has(count, limit);
  std::vector<std::string> lines = reader.lines();
  lines.resize(std::min(lines.size(), count));
  return lines;
}

std::string FirstLineOf(int output, Duration limit) {
  const std::vector<std::string> lines = LinesOf(output, 1, limit);
  return lines.empty() ? "" : lines.front();
}

void EndChild(pid_t pid, Duration limit) {
  if (pid <= 0) return;  // kill() would send the signal to other processes
  kill(pid, SIGTERM);
  const TimePoint end = Clock::now() + limit;
  while (waitpid(pid, nullptr, WNOHANG) == 0) {
    if (Clock::now() > end) kill(pid, SIGKILL);
    std::this_thread::sleep_for(milliseconds(5));
  }
}

std::string HowItEnded(int status) {
  if (WIFSIGNALED(status)) {
    return fmt::format("was killed by signal {} ({})", WTERMSIG(status),
                       strsignal(WTERMSIG(status)));
  }
  return fmt::format("exited with code {}", WEXITSTATUS(status));
}

std::filesystem::path ProgramBeside(std::string_view name) { return OwnFolder() / name; }

std::string BuildFolder() {
  std::error_code error;
  const std::filesystem::path build = OwnFolder().parent_path();
  if (!std::filesystem::exists(build / "build.ninja", error)) return "";
  const std::filesystem::path here = std::filesystem::current_path(error);  // "" if it is deleted
  const std::filesystem::path from_here = build.lexically_relative(here);
  const bool is_below = !from_here.empty() && *from_here.begin() != "..";
  return ShellWord((is_below ? from_here : build).string());
}

std::string BuildCommand(std::string_view target) {
  const std::string build = BuildFolder();
  return build.empty() ? "" : fmt::format("ninja -C {} {}", build, target);
}

std::string HowToBuild(std::string_view name) {
  const std::string command = BuildCommand(name);
  return command.empty() ? "" : "; it is built by: " + command;
}

std::filesystem::path BuiltProgramBeside(std::string_view name) {
  std::filesystem::path program = ProgramBeside(name);
  if (std::filesystem::exists(program)) return program;
  throw std::runtime_error(fmt::format("cannot start {}: {}{}", program.string(),
                                       std::strerror(ENOENT), HowToBuild(name)));
}

std::filesystem::path ProgramOf(Role role) {
  return ProgramBeside(fmt::format("fogline-{}", NameOf(role)));
}

}  // namespace fogline::processes
