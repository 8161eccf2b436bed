// Examines the processes of Fogline on this machine, from /proc (proc(5)): runs, and roles that
// were started without a runner.
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

#include <fmt/core.h>

#include "tools/doctor/doctor_findings.h"

namespace fogline::doctor {
namespace {

using Level = Finding::Level;
constexpr std::string_view kDeleted = " (deleted)";

/// Whether the program starts the roles of runs.
bool IsRunner(std::string_view program) {
  return program == "fogline" || program == "fogline-experiment";
}

struct Process {
  pid_t pid = 0;
  pid_t parent = 0;
  char state = '?';
  std::string program;    // such as "fogline-radar"
  bool replaced = false;  // the file of the program was removed or replaced
  std::vector<std::string> arguments;

  /// Value of an option; "" if the option is missing.
  std::string Option(std::string_view name) const {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      if (arguments[i] == name && i + 1 < arguments.size()) return arguments[i + 1];
      if (arguments[i].starts_with(std::string(name) + "=")) {
        return arguments[i].substr(name.size() + 1);
      }
    }
    return "";
  }
  std::string Describe() const { return fmt::format("{} (pid {})", program, pid); }
};

std::optional<Process> ReadProcess(const std::filesystem::path& folder) {
  Process process;
  const std::string name = folder.filename().string();
  const char* end = name.data() + name.size();
  if (std::from_chars(name.data(), end, process.pid).ptr != end) return std::nullopt;
  std::error_code error;  // the process may end meanwhile, or belong to another user
  std::string program = std::filesystem::read_symlink(folder / "exe", error).string();
  if (program.ends_with(kDeleted)) {
    process.replaced = true;
    program.resize(program.size() - kDeleted.size());
  }
  process.program = std::filesystem::path(program).filename().string();
  if (process.program != "fogline" && !process.program.starts_with("fogline-")) return std::nullopt;
  std::ifstream arguments(folder / "cmdline");
  for (std::string word; std::getline(arguments, word, '\0');) process.arguments.push_back(word);
  std::ifstream in(folder / "stat");
  std::string stat;
  std::getline(in, stat);
  // "PID (NAME) STATE PARENT ...", where a name may contain parentheses.
  std::istringstream fields(stat.substr(std::min(stat.size(), stat.rfind(')') + 1)));
  fields >> process.state >> process.parent;
  return process;
}

std::map<pid_t, Process> ReadProcesses() {
  std::map<pid_t, Process> processes;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
    auto process = ReadProcess(entry.path());
    if (process && process->pid != getpid()) processes[process->pid] = std::move(*process);
  }
  return processes;
}

Finding AssessRole(const Process& role, bool has_runner) {
  const std::string url = role.Option("--lcm-url");
  const std::string where = url.empty() ? "" : " on " + url;
  const std::string run_id = role.Option("--run-id");
  if (!has_runner && !run_id.empty()) {
    return {"processes", Level::kWarning,
            fmt::format("{}{} takes part in no other run than {}, whose runner has not started it",
                        role.Describe(), where, run_id),
            fmt::format("if this run is over: kill {}", role.pid)};
  }
  if (role.state == 'T') {
    return {"processes", Level::kWarning, fmt::format("{}{} is stopped", role.Describe(), where),
            fmt::format("kill -CONT {}", role.pid)};
  }
  if (role.replaced) {
    return {"processes", Level::kWarning,
            fmt::format("{}{} is older than its program, which has been rebuilt", role.Describe(),
                        where),
            fmt::format("kill {}, and start it again", role.pid)};
  }
  return {"processes", Level::kOk, fmt::format("{}{} runs by itself", role.Describe(), where), ""};
}

}  // namespace

void ExamineProcesses(Findings& findings) {
  const std::map<pid_t, Process> processes = ReadProcesses();
  std::map<pid_t, std::vector<const Process*>> runs;  // the programs of each runner
  bool any = false;
  for (const auto& [pid, process] : processes) {
    if (IsRunner(process.program)) continue;
    const auto parent = processes.find(process.parent);
    const bool has_runner = parent != processes.end() && IsRunner(parent->second.program);
    const Finding finding = AssessRole(process, has_runner);
    if (has_runner) runs[process.parent].push_back(&process);
    // A role of a run gets a line of its own only if it has a problem. Below, each run gets one
    // line for all its roles.
    if (has_runner && finding.level == Level::kOk) continue;
    findings.push_back(finding);
    any = true;
  }
  for (const auto& [runner, children] : runs) {
    // A runner also starts programs that are no roles: a relay, and the page of a log.
    const auto role = std::ranges::find_if(
        children, [](const Process* child) { return !child->Option("--run-id").empty(); });
    if (role == children.end()) continue;
    any = true;
    findings.push_back(
        {"processes", Level::kOk,
         fmt::format("{} has a run with {} processes on {}", processes.at(runner).Describe(),
                     children.size(), (*role)->Option("--lcm-url")),
         ""});
  }
  if (!any) {
    findings.push_back({"processes", Level::kOk, "no role runs on this machine", ""});
  }
}

}  // namespace fogline::doctor
