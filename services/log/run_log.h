// A run in an event log: its scenario and its steps, one after another.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "scenario/sections/scenario.h"
#include "services/log/event_log.h"
#include "services/log/log_seal.h"
#include "services/log/realtime_figures.h"

namespace fogline::log {

/// The messages of one step by place in kChannels; empty where there is none.
using StepMessages = std::array<runtime::Bytes, kNumChannels>;

/// The contents of a log, apart from its steps.
struct RunLog {
  std::int64_t run_id = 0;
  Scenario scenario;
  std::string scenario_text;
  std::string scenario_hash;
  std::int64_t steps = 0;  // number of complete steps
  std::string digest;      // digest of these steps
  // True if the last step is marked as the last of the run, nothing was changed since the log was
  // sealed, and (in lockstep) nothing is missing.
  bool complete = false;
  std::string note;  // why it is not complete, or what was ignored; "" if there is nothing to say
  LogHead events{};  // all whole events of the file
  std::optional<LogSeal> seal;              // none in a log of lcm-logger or of an interrupted run
  bool altered = false;                     // the log differs from its seal
  std::optional<RealtimeFigures> realtime;  // set for a run in real time
};

/// Reads the run in a log that the recorder or lcm-logger wrote, step by step, with events in any
/// order. Memory is bounded if the events are in order.
class RunLogReader {
 public:
  /// The part of a log that is compared with its seal.
  enum class Compared {
    kRun,   // scenario and steps; in real time the whole file, because STATUS counts
    kFile,  // all bytes of the file, which are read once more at the end
  };

  /// @throws InputError when the file cannot be read or is no event log
  explicit RunLogReader(const std::filesystem::path& file, Compared compared = Compared::kRun);
  ~RunLogReader();

  /// The next complete step, from 0 on; nullptr at the end. Its bytes are valid as long as the
  /// reader. In real time it is the next step, complete or not.
  /// @throws InputError at the end, when the log has no scenario of a run
  const StepMessages* Next();

  /// The contents of the whole log. Known once Next() has reached the end of the log.
  const RunLog& run() const;

 private:
  class Assembler;
  std::unique_ptr<Assembler> assembler_;
};

}  // namespace fogline::log
