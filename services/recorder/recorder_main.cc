// The recorder as a process: an event log of one run, complete by construction. It is no general
// logger of LCM traffic (that is lcm-logger) and computes nothing.
#include "services/recorder/recorder.h"

#include <CLI/CLI.hpp>

#include "services/runtime/service.h"

namespace {

constexpr const char* kHelpFooter =
    "Exit codes: 0 stopped by the runner, 2 bad usage, 3 failed, 130 interrupted.\n\n"
    "Example: as `fogline run` starts it; a run has one recorder, so a second log is that of\n"
    "lcm-logger\n"
    "  fogline-recorder --log logs/run.lcm --lcm-url 'udpm://239.255.76.67:7700?ttl=0'";

}  // namespace

int main(int argc, char** argv) {
  using fogline::Recorder;
  std::string file;
  bool resume = false;
  return fogline::RunProcess(
      argc, argv, fogline::Role::kRecorder,
      [&](fogline::Bus& bus, std::optional<std::int64_t> run_id) {
        return std::make_unique<Recorder>(
            bus, run_id, file, resume ? Recorder::Existing::kResume : Recorder::Existing::kReplace);
      },
      [&](CLI::App& app) {
        app.add_option("--log", file, "Event log to write; an existing file is replaced")
            ->required();
        app.add_flag("--resume", resume,
                     "Go on with the log of a recorder that was killed in the same run");
        app.footer(kHelpFooter);  // not the other roles', which join a run from outside
      });
}
