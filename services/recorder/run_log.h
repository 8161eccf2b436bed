// A run as it stands in an event log: its scenario and its steps, one after another.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "scenario/scenario.h"
#include "services/recorder/event_log.h"
#include "services/recorder/log_seal.h"
#include "services/recorder/realtime_figures.h"

namespace fogline {

/// The messages of one step by place in kChannels; empty where there is none.
using StepMessages = std::array<Bytes, kNumChannels>;

/// What a log is, apart from its steps.
struct RunLog {
  std::int64_t run_id = 0;
  Scenario scenario;
  std::string scenario_text;
  std::string scenario_hash;
  std::int64_t steps = 0;  // complete ones
  std::string digest;      // of these
  // The last step says that it is the last; in lockstep nothing is missing; nothing was changed
  // since the log was sealed.
  bool complete = false;
  std::string note;             // why it is not complete, or what was ignored; "" if nothing
  LogHead events{};             // all whole ones of the file
  std::optional<LogSeal> seal;  // lcm-logger's logs have none, nor has a run that was cut off
  bool altered = false;         // the log is not what its seal says
  std::optional<RealtimeFigures> realtime;  // of a run in real time
};

/// Reads the run of a log that the recorder or lcm-logger wrote, step by step, in whatever order
/// its events stand; within bounded memory when they are in order.
class RunLogReader {
 public:
  /// What is compared with the seal.
  enum class Compared {
    kRun,   // scenario and steps; in real time the file, because STATUS counts there
    kFile,  // all bytes of the file, once more at its end
  };

  /// @throws InputError when the file cannot be read or is no event log
  explicit RunLogReader(const std::filesystem::path& file, Compared compared = Compared::kRun);
  ~RunLogReader();

  /// The next complete step, from 0 on; the bytes live as long as the reader. nullptr at the end.
  /// In real time the next step, complete or not.
  /// @throws InputError at the end, when the log has no scenario of a run
  const StepMessages* Next();

  /// About the whole log, once Next() has come to its end.
  const RunLog& run() const;

 private:
  class Assembler;
  std::unique_ptr<Assembler> assembler_;
};

}  // namespace fogline
