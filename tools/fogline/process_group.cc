#include "tools/fogline/process_group.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "scenario/file.h"
#include "tools/fogline/child.h"

namespace fogline {
namespace {

[[noreturn]] void Become(const char* program, char* const* arguments, int output, pid_t parent) {
  BecomeChild(parent, output);
  dup2(output, STDERR_FILENO);
  execv(program, arguments);
  constexpr char kText[] = "cannot be started\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kText, sizeof(kText) - 1);
  _exit(127);
}

std::string HowItEnded(int status) {
  if (WIFSIGNALED(status)) {
    return fmt::format("was killed by signal {} ({})", WTERMSIG(status),
                       strsignal(WTERMSIG(status)));
  }
  return fmt::format("exited with code {}", WEXITSTATUS(status));
}

}  // namespace

ProcessGroup::~ProcessGroup() {
  Signal(SIGKILL);
  for (const Process& process : processes_) {
    waitpid(process.pid, nullptr, 0);
    close(process.output);
  }
}

pid_t ProcessGroup::Start(Role role, const std::filesystem::path& program,
                          const std::vector<std::string>& arguments) {
  // Inherited as ignored, it would keep the ends of processes from us.
  std::signal(SIGCHLD, SIG_DFL);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    ThrowIfExhausted(errno, "cannot make a pipe");
    throw std::runtime_error(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  }
  fcntl(ends[0], F_SETFL, O_NONBLOCK);
  const std::string path = program.string();
  std::vector<char*> argv{const_cast<char*>(path.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) Become(path.c_str(), argv.data(), ends[1], parent);
  close(ends[1]);
  if (pid < 0) {
    close(ends[0]);
    throw std::runtime_error(fmt::format("cannot start {}: {}", path, std::strerror(errno)));
  }
  processes_.push_back({.role = role, .pid = pid, .output = ends[0], .printed = {}});
  return pid;
}

std::vector<ProcessGroup::Exit> ProcessGroup::Collect() {
  std::vector<Exit> exits;
  for (auto process = processes_.begin(); process != processes_.end();) {
    ReadOutput(*process);
    int status = 0;
    if (waitpid(process->pid, &status, WNOHANG) != process->pid) {
      ++process;
      continue;
    }
    ReadOutput(*process);
    close(process->output);
    exits.push_back({.role = process->role,
                     .pid = process->pid,
                     .how = HowItEnded(status),
                     .killed = WIFSIGNALED(status),
                     .lines = process->printed.Take()});
    process = processes_.erase(process);
  }
  return exits;
}

std::string ProcessGroup::Describe() const {
  std::string text;
  for (const Process& process : processes_) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", NameOf(process.role), process.pid);
  }
  return text;
}

void ProcessGroup::Signal(int signal) {
  for (const Process& process : processes_) kill(process.pid, signal);
}

void ProcessGroup::ReadOutput(Process& process) {
  // What a pipe holds (see pipe(7)); who prints without end must not keep us here.
  constexpr int kReads = 16;
  std::array<char, 4096> buffer{};
  for (int i = 0; i < kReads; ++i) {
    const ssize_t size = read(process.output, buffer.data(), buffer.size());
    if (size <= 0) return;
    process.printed.Append({buffer.data(), static_cast<std::size_t>(size)});
  }
}

}  // namespace fogline
