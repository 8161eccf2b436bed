// The recorder as a process: an event log of one run, complete by construction. It is no general
// logger of LCM traffic (that is lcm-logger) and computes nothing.
#include "services/recorder/recorder.h"

#include <CLI/CLI.hpp>

#include "services/runtime/service.h"

int main(int argc, char** argv) {
  std::string file;
  return fogline::RunProcess(
      argc, argv, fogline::Role::kRecorder,
      [&file](fogline::Bus& bus, std::optional<std::int64_t> run_id) {
        return std::make_unique<fogline::Recorder>(bus, run_id, file);
      },
      [&file](CLI::App& app) {
        app.add_option("--log", file, "Event log to write; an existing file is replaced")
            ->required();
      });
}
