// Examines the machine: clocks, real-time priority, processors, disk.
#include <pwd.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "common/clock.h"
#include "tools/doctor/doctor_findings.h"

namespace fogline::doctor {
namespace {

using Level = Finding::Level;

std::string FirstWord(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string word;
  in >> word;
  return word;
}

void ExamineClock(Findings& findings) {
  constexpr long kFineEnoughNs = 1000;
  timespec resolution{};
  clock_getres(CLOCK_MONOTONIC, &resolution);
  const std::string source =
      FirstWord("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  const bool fine = resolution.tv_sec == 0 && resolution.tv_nsec <= kFineEnoughNs;
  findings.push_back({"clock", fine ? Level::kOk : Level::kWarning,
                      fmt::format("CLOCK_MONOTONIC has a resolution of {} ns{}",
                                  resolution.tv_sec * 1'000'000'000 + resolution.tv_nsec,
                                  source.empty() ? "" : fmt::format(" (source {})", source)),
                      fine ? "" : "real time needs a high-resolution clock source"});
}

/// While an object exists, this thread has the priority of a role in real time, so the kernel runs
/// it before ordinary processes. The kernel may refuse the priority.
class Priority {
 public:
  Priority() {
    sched_param wanted{};
    wanted.sched_priority = 1;
    if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &wanted) != 0) error_ = errno;
  }
  ~Priority() {
    const sched_param usual{};
    if (error_ == 0) sched_setscheduler(0, SCHED_OTHER, &usual);
  }
  Priority(const Priority&) = delete;
  Priority& operator=(const Priority&) = delete;

  /// The error number of the refusal; 0 if the kernel has granted the priority.
  int error() const { return error_; }

 private:
  int error_ = 0;
};

std::string UserName() {
  const passwd* user = getpwuid(getuid());
  return user != nullptr ? user->pw_name : std::to_string(getuid());
}

/// Examines whether the kernel grants the priority and the locked memory that a role in real time
/// asks for (RunBeforeOthers()).
void ExaminePriority(const std::filesystem::path& programs, Findings& findings) {
  const auto report = [&](std::string_view what, int error) {
    findings.push_back(
        error == 0 ? Finding{"realtime_priority", Level::kOk,
                             fmt::format("roles in real time get {}", what), ""}
                   : Finding{"realtime_priority", Level::kWarning,
                             fmt::format("roles in real time do not get {}: {}", what,
                                         std::strerror(error)),
                             "on a busy machine steps of a run in real time begin late: see the "
                             "recipes",
                             PriorityRecipes(UserName(), programs.string())});
  };
  const int refused = Priority().error();
  report("priority over other processes (SCHED_FIFO)", refused);
  const bool locks = mlockall(MCL_CURRENT | MCL_ONFAULT) == 0;
  const int error = locks ? 0 : errno;
  if (locks) munlockall();
  // The same recipes grant priority and locked memory, so they are shown only once.
  report("locked memory", error);
  if (refused != 0 && error != 0) findings.back().recipes.clear();
}

/// Measures how late a process wakes up after a sleep of one millisecond, over many sleeps.
void ExamineWakeUp(Findings& findings) {
  constexpr int kSleeps = 200;
  constexpr Duration kSleep = milliseconds(1);
  constexpr double kTooLateMs = 5;  // in real time, a step that begins this late counts as late
  const Priority priority;
  std::vector<double> late_ms;
  TimePoint due = Clock::now();
  for (int i = 0; i < kSleeps; ++i) {
    due = std::max(due + kSleep, Clock::now());
    std::this_thread::sleep_until(due);
    late_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - due).count());
  }
  std::ranges::sort(late_ms);
  const double p99_ms = late_ms[late_ms.size() * 99 / 100];
  const bool late = p99_ms > kTooLateMs;
  findings.push_back(
      {"wakeup", late ? Level::kWarning : Level::kOk,
       fmt::format("sleepers wake up late by {:.3f} ms (median), {:.3f} ms (99 %), "
                   "{:.3f} ms (worst of {}){}",
                   late_ms[late_ms.size() / 2], p99_ms, late_ms.back(), late_ms.size(),
                   priority.error() == 0 ? ", with real-time priority" : ""),
       late ? "end other work, or give Fogline processors of its own: real time "
              "will miss ticks; lockstep only slows down"
            : ""});
}

void ExamineTimeSynchronisation(Findings& findings) {
  timex state{};
  const bool synchronised = adjtimex(&state) >= 0 && (state.status & STA_UNSYNC) == 0;
  findings.push_back({"time_sync", Level::kOk,
                      synchronised ? "the wall clock is synchronised"
                                   : "the wall clock is not synchronised. Runs do not need this; a "
                                     "comparison of times of several machines does (chrony, ptp4l)",
                      ""});
}

void ExamineProcessors(Findings& findings) {
  cpu_set_t set;
  CPU_ZERO(&set);
  const int usable = sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 1;
  findings.push_back({"cpus", usable > 1 ? Level::kOk : Level::kWarning,
                      fmt::format("{} processor{} usable", usable, usable == 1 ? " is" : "s are"),
                      usable > 1 ? "" : "the processes of a run share it: steps take longer"});
  std::set<std::string> governors;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &set)) continue;
    const std::string governor =
        FirstWord(fmt::format("/sys/devices/system/cpu/cpu{}/cpufreq/scaling_governor", cpu));
    if (!governor.empty()) governors.insert(governor);
  }
  if (governors.empty()) {
    findings.push_back({"governor", Level::kOk, "no frequency governor is visible", ""});
    return;
  }
  const bool full = governors == std::set<std::string>{"performance"};
  findings.push_back(
      {"governor", full ? Level::kOk : Level::kWarning,
       fmt::format("frequency governor: {}", fmt::join(governors, ", ")),
       full ? "" : "for real time and benchmarks: cpupower frequency-set -g performance"});
}

void ExamineDisk(Findings& findings) {
  constexpr double kMega = 1e6;
  // A run of the paper's scenario takes about 1 MB.
  constexpr double kLittleMB = 1000;
  constexpr double kTooLittleMB = 20;
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::is_directory("logs", error) ? "logs" : ".";
  const std::string name = std::filesystem::absolute(folder, error).lexically_normal().string();
  const auto space = std::filesystem::space(folder, error);
  if (error || access(folder.c_str(), W_OK) != 0) {
    findings.push_back({"disk", Level::kProblem, fmt::format("{} cannot be written", name),
                        "change to a folder of your own, or use --log FILE"});
    return;
  }
  const double free_mb = static_cast<double>(space.available) / kMega;
  const Level level = free_mb < kTooLittleMB ? Level::kProblem
                      : free_mb < kLittleMB  ? Level::kWarning
                                             : Level::kOk;
  findings.push_back(
      {"disk", level, fmt::format("{:.0f} MB are free for logs in {}", free_mb, name),
       level == Level::kOk ? "" : "delete old logs, or use --log with a file elsewhere"});
}

}  // namespace

void ExamineMachine(const std::filesystem::path& programs, Findings& findings) {
  ExamineClock(findings);
  ExaminePriority(programs, findings);
  ExamineWakeUp(findings);
  ExamineTimeSynchronisation(findings);
  ExamineProcessors(findings);
  ExamineDisk(findings);
}

}  // namespace fogline::doctor
