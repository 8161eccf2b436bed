// The recorder as a process: it writes the event log of one run. The recorder is not a general
// logger of LCM traffic (use `fogline record` for this), and computes no messages.
#include "services/recorder/recorder.h"

#include <memory>
#include <optional>

#include "common/file_lock.h"
#include "services/log/log_guard.h"
#include "services/runtime/process/service.h"

namespace {

constexpr const char* kHelpFooter =
    "Exit codes: 0 stopped by the runner, 2 bad usage, 3 failed, 130 interrupted.\n\n"
    "Example: `fogline run` starts it like this. A run has one recorder; use `fogline record`\n"
    "for a second log.\n"
    "  fogline-recorder --run-id 7351 --shared-log --log logs/run.lcm \\\n"
    "    --lcm-url 'udpm://239.255.76.67:7700?ttl=0'";

}  // namespace

int main(int argc, char** argv) {
  using fogline::FileLock;
  using fogline::log::LogGuard;
  using fogline::recorder::Recorder;
  std::string file;
  bool resume = false;
  bool shared = false;
  bool wall_clock = false;
  // One of these two objects locks the log while the recorder writes it.
  std::optional<FileLock> lock;
  std::unique_ptr<LogGuard> log;
  return fogline::runtime::RunProcess(
      argc, argv, fogline::Role::kRecorder,
      [&](fogline::runtime::Bus& bus, std::optional<std::int64_t> run_id) {
        if (shared) {
          lock.emplace(file, FileLock::Kind::kShared, "--log", "run");
        } else {
          log.reset();  // releases the lock that an earlier call took
          log = std::make_unique<LogGuard>(file);
        }
        return std::make_unique<Recorder>(
            bus, run_id, file, resume ? Recorder::Existing::kResume : Recorder::Existing::kReplace,
            wall_clock ? Recorder::WallClock::kYes : Recorder::WallClock::kNo);
      },
      [&](fogline::runtime::ProgramOptions& options) {
        options.RequiredText("--log", file, "Event log to write; an existing file is replaced");
        options.Flag("--resume", resume,
                     "Go on with the log of a recorder that was killed in the same run");
        options.Flag("--shared-log", shared,
                     "The log is locked by the runner, which has started this recorder");
        options.Flag("--wall-clock", wall_clock,
                     "Also write the wall clock of each step (always on in real time)");
        options.Footer(kHelpFooter);  // replaces the footer of the other roles
      });
}
