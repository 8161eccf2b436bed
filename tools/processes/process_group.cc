#include "tools/processes/process_group.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <fstream>
#include <utility>

#include <fmt/core.h>

#include "common/process/this_process.h"
#include "tools/processes/child.h"

namespace fogline::processes {

ProcessGroup::ProcessGroup() : host_(HostName()) {}

ProcessGroup::~ProcessGroup() {
  Signal(SIGKILL);
  for (const Process& process : processes_) {
    waitpid(process.pid, nullptr, 0);
    close(process.output);
  }
}

pid_t ProcessGroup::Start(Role role, const std::filesystem::path& program,
                          const std::vector<std::string>& arguments) {
  Pipe output;
  fcntl(output.read, F_SETFL, O_NONBLOCK);
  const pid_t pid = StartChild(program, arguments, output.write, output.write);
  processes_.push_back(
      {.role = role, .pid = pid, .output = std::exchange(output.read, -1), .printed = {}});
  return pid;
}

pid_t ProcessGroup::StartRole(Role role, const std::vector<std::string>& arguments) {
  return Start(role, ProgramOf(role), arguments);
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

void ProcessGroup::Kill(pid_t pid) {
  // Kills only a process that is still in this group. After Collect() has removed a process, the
  // system may give the id of this process to another process.
  if (std::ranges::find(processes_, pid, &Process::pid) != processes_.end()) kill(pid, SIGKILL);
}

void ProcessGroup::Signal(int signal) {
  for (const Process& process : processes_) kill(process.pid, signal);
}

void ProcessGroup::ReadOutput(Process& process) {
  // This number of reads empties a full pipe (see pipe(7)). Without a limit, a process that prints
  // without end would keep the runner in this loop for ever.
  constexpr int kReads = 16;
  std::array<char, 4096> buffer{};
  for (int i = 0; i < kReads; ++i) {
    const ssize_t size = read(process.output, buffer.data(), buffer.size());
    if (size <= 0) return;
    process.printed.Append({buffer.data(), static_cast<std::size_t>(size)});
  }
}

std::optional<std::int64_t> OwnActivityOf(pid_t pid) {
  std::ifstream status(fmt::format("/proc/{}/status", pid));
  std::int64_t sum = 0;
  // A process that only computes, alone on its core, may have no context switch for seconds. The
  // first number of schedstat is the processor time of its main thread, in ns.
  std::ifstream(fmt::format("/proc/{}/schedstat", pid)) >> sum;
  bool known = false;
  for (std::string key; status >> key;) {
    if (!key.ends_with("voluntary_ctxt_switches:")) continue;
    std::int64_t count = 0;
    known = static_cast<bool>(status >> count);
    sum += count;
  }
  return known ? std::optional(sum) : std::nullopt;
}

}  // namespace fogline::processes
