// How a log is read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fogline::log {

struct ReadOptions {
  /// The part of a log that is compared with its seal.
  enum class Compared {
    // In lockstep the scenario and the steps. In real time all bytes of the file, because some
    // results of the run come from the STATUS messages.
    kRun,
    kFile,  // all bytes of the file, which are read again at the end
  };

  Compared compared = Compared::kRun;
  /// In lockstep: whether the reader also returns steps that lack messages. Otherwise the reader
  /// ends before the first of these steps.
  bool gaps = false;
  /// Whether the log is known to have every message that the recorder has received. A log that
  /// agrees with its seal always has all these messages.
  bool has_all = false;
  /// The run to read; nullopt: the first run in the log.
  std::optional<std::int64_t> run_id;
  /// The effective scenario of a log that lacks its scenario; "": not known.
  std::string scenario_text;
  /// Whether a log without a scenario is refused.
  bool needs_scenario = true;
};

}  // namespace fogline::log
