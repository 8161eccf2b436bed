// A run in an event log: its scenario and its steps, one after another.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenario/sections/scenario.h"
#include "services/log/event_log.h"
#include "services/log/gaps/log_gaps.h"
#include "services/log/gaps/other_runs.h"
#include "services/log/gaps/read_options.h"
#include "services/log/log_seal.h"
#include "services/log/realtime_figures.h"
#include "services/runtime/realtime/culprit.h"

namespace fogline::log {

/// The messages of one step, by index in kChannels. A missing message is empty.
using StepMessages = std::array<runtime::Bytes, kNumChannels>;

/// The channels of which the step has a message.
inline runtime::ChannelSet ChannelsIn(const StepMessages& messages) {
  runtime::ChannelSet there;
  for (std::size_t i = 0; i < kNumChannels; ++i) there[i] = !messages[i].empty();
  return there;
}

/// The contents of a log, apart from its steps.
struct RunLog {
  std::int64_t run_id = 0;
  Scenario scenario;
  std::string scenario_text;
  std::string scenario_hash;
  runtime::ChannelSet channels;  // the channels of a step (log_graph.h)
  std::int64_t steps = 0;        // number of complete steps; in real time, of all steps
  // Digest of these steps. It is empty if there are no such steps. It is also empty if the log has
  // gaps and the reader accepts them (ReadOptions::gaps).
  std::string digest;
  // Whether the log has the whole run, up to its end. This is true under these conditions:
  // - The scenario is known.
  // - The log ends with the last step of the run, and no event is cut off.
  // - The log was not changed after it was sealed.
  // - No two messages of one step and channel differ. (A message is not compared if Next() has
  //   already returned its step.)
  // - In lockstep: the log has all messages.
  bool ended = false;
  // Whether only an incomplete event at the end of the log keeps `ended` from being true.
  bool ends_torn = false;
  // Whether `ended` is true and the log has every published message. In lockstep this is the same
  // as `ended`. In real time, STATUS messages in the log must show that no published message is
  // missing (RealtimeFigures::unlogged_messages and unlogged_channels).
  bool complete = false;
  // Why the log is not complete, or what was ignored; "" if there is no such remark.
  std::string note;
  LogHead events{};                         // all whole events of the file
  std::optional<LogSeal> seal;              // nullopt if the log has no seal
  bool altered = false;                     // the log differs from its seal
  std::optional<RealtimeFigures> realtime;  // set for a run in real time
  LogGaps gaps;                             // in lockstep, if they were read (ReadOptions::gaps)
  std::vector<RunInLog> other_runs;         // the first other runs of which the log has messages
  // Whether the scenario is known. Always true if ReadOptions::needs_scenario.
  bool has_scenario = true;
};

/// The digest as text: "unknown" if it is empty.
inline std::string DigestText(const RunLog& run) {
  return run.digest.empty() ? "unknown" : run.digest;
}

/// Reads a run step by step from a log that the recorder or lcm-logger wrote. The events may be in
/// any order. If the events are in order, the memory use is bounded.
class RunLogReader {
 public:
  using Compared = ReadOptions::Compared;

  /// @throws InputError if the file cannot be read or is not an event log
  explicit RunLogReader(const std::filesystem::path& file, Compared compared = Compared::kRun)
      : RunLogReader(file, ReadOptions{.compared = compared}) {}
  RunLogReader(const std::filesystem::path& file, const ReadOptions& options);
  ~RunLogReader();

  /// The next complete step, from 0 on; nullptr at the end. In real time the step may be
  /// incomplete. With ReadOptions::gaps the steps begin with the first step of which the log has a
  /// message, and may be incomplete or empty. The bytes of the step are valid for the lifetime of
  /// the reader. After an exception, Next() returns nullptr.
  /// @throws InputError at the end of the log if the log has no scenario, lacks the chosen run, or
  /// has another scenario than the given one. In real time, Next() also throws at the first message
  /// of a run with an invalid scenario. Next() also throws at a message with the type of another
  /// version of Fogline; the error then names this version.
  const StepMessages* Next();
  /// The number of the step that Next() has returned.
  std::int64_t step() const;
  /// Whether this step is one of the incomplete steps at the end of the log that a run leaves when
  /// it ends early. The missing messages of these steps are not gaps.
  bool InTail() const;
  /// Whether the steps may be incomplete because the log lacks messages: ReadOptions::gaps is set,
  /// and the run is in lockstep.
  bool ReadsGaps() const;

  /// The contents of the whole log. Known after Next() has returned nullptr.
  const RunLog& run() const;

 private:
  class Assembler;
  std::unique_ptr<Assembler> assembler_;
};

}  // namespace fogline::log
