// Where each message of a log stands, by step and channel: any step can be shown at once. Also the
// run's description and its events.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "services/log/event_log.h"
#include "services/log/run_log.h"
#include "services/log/step_order.h"
#include "tools/web/run_events.h"

namespace fogline::web {

/// Reads a log once and keeps it mapped. The memory is eight bytes for each message, and the pages
/// of the file that were read last, which the system may take back.
///
/// The index also has the messages of incomplete steps, and those behind a step that is missing. So
/// it may have more steps than RunLogReader, which stops at a step that is not complete.
class LogIndex {
 public:
  /// @param run_id the run to read; nullopt: the first run in the log
  /// @throws InputError if the file cannot be read, is no event log, has no scenario of a run, or
  ///     lacks the chosen run
  explicit LogIndex(const std::filesystem::path& file,
                    std::optional<std::int64_t> run_id = std::nullopt);

  const log::RunLog& run() const { return run_; }
  /// The first and the last step of which there is a message; 0 and -1 if there is none.
  std::int64_t first_step() const { return first_; }
  std::int64_t last_step() const { return static_cast<std::int64_t>(rows_.size()) - 1; }
  /// The messages in the index.
  std::int64_t messages() const { return messages_; }

  /// The message of a step, without its signature; empty if the log lacks the message. It is valid
  /// as long as the index.
  /// @param channel its place in kChannels
  runtime::Bytes Message(std::int64_t step, std::size_t channel) const;

  const std::vector<RunEvent>& events() const { return events_.events(); }

 private:
  // Place of a message in the file; size 0: there is none.
  struct Place {
    std::uint64_t offset : 44 = 0;
    std::uint64_t size : 20 = 0;
  };
  using Row = std::array<Place, log::kStepChannels>;

  void ReadRun(const std::filesystem::path& file, std::optional<std::int64_t> run_id);
  void ReadPlaces();
  void Take(const log::Event& event);
  void TakeStep(std::size_t row, runtime::Bytes data);
  void FindEvents();

  log::EventLogReader reader_;
  log::RunLog run_;
  RunEvents events_;
  std::vector<Row> rows_;  // by step
  std::int64_t first_ = 0;
  std::int64_t messages_ = 0;
  std::int64_t read_ = 0;   // events that have been read
  std::size_t guess_ = 0;   // the channel of the next event, probably
  bool is_signed_ = false;  // whether the run's messages are signed
  bool knows_run_ = false;  // whether a RUN message of the run has come
};

}  // namespace fogline::web
