// fogline replay --live: recorded messages replace some roles of a new run; the other roles
// compute.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/runner/scenario_run.h"

namespace fogline {

class LiveReplay {
 public:
  /// Adds --live and the options that need it.
  explicit LiveReplay(CLI::App& verb);

  bool chosen() const { return live_; }
  /// Makes the run, and prints how much its track differs from the recorded track.
  /// @param recorded_run id of the recorded run; nullopt: the first run in the log
  /// @return the exit code
  /// @throws InputError, Interrupted, std::runtime_error like RunScenario()
  int Run(const std::filesystem::path& recorded, std::optional<std::int64_t> recorded_run,
          bool json) const;

 private:
  /// Sets the network of the new run. @throws InputError if LCM_DEFAULT_URL is wrong
  void ChooseTransport(runner::RunOptions& options) const;

  bool live_ = false;
  std::string channels_ = "RADAR,LIDAR";
  std::vector<std::string> overrides_;
  std::filesystem::path log_;
  bool force_ = false;
  std::string transport_;  // "": the default
  bool realtime_ = false;
  double speed_ = 0;  // 0: the speed of the recorded run
  bool quiet_ = false;
};

}  // namespace fogline
