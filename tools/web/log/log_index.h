// The place of each message in a log, by step and channel. So any step can be shown without reading
// the log from its beginning. The index also has the run's description and its events.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <optional>
#include <vector>

#include "services/graph.h"
#include "services/log/event_log.h"
#include "services/log/run_log.h"
#include "services/log/step_order.h"
#include "tools/web/run_events.h"

namespace fogline::web {

/// Reads a log once, and keeps the file mapped. The index needs eight bytes of memory for each
/// message. The system may also keep recently read pages of the file in memory.
///
/// The index also has the messages of incomplete steps, and the messages after a missing step. So
/// it may have more steps than RunLogReader, which stops at an incomplete step.
class LogIndex {
 public:
  /// @param run_id the run to read; nullopt: the first run in the log
  /// @throws InputError if the file cannot be read, is no event log, has no scenario of a run, or
  ///     lacks the chosen run
  explicit LogIndex(const std::filesystem::path& file,
                    std::optional<std::int64_t> run_id = std::nullopt);

  const log::RunLog& run() const { return run_; }
  /// The first and the last step that have a message; 0 and -1 if no step has a message.
  std::int64_t first_step() const { return first_; }
  std::int64_t last_step() const { return static_cast<std::int64_t>(rows_.size()) - 1; }
  /// Number of messages in the index that belong to a step.
  std::int64_t messages() const { return messages_; }

  /// The message of a step, without its signature; empty if the log lacks the message. The bytes
  /// are valid as long as the index exists.
  /// @param channel index of the channel in kChannels
  runtime::Bytes Message(std::int64_t step, std::size_t channel) const;

  /// Number of messages on a channel with Pace::kControl: its messages do not belong to steps.
  std::int64_t control_messages(std::size_t channel) const { return std::ssize(control_[channel]); }
  /// The i-th message on a channel with Pace::kControl, in the order of the log and without its
  /// signature. The bytes are valid as long as the index exists.
  runtime::Bytes ControlMessage(std::size_t channel, std::int64_t i) const {
    return At(control_[channel][static_cast<std::size_t>(i)]);
  }

  const std::vector<RunEvent>& events() const { return events_.events(); }
  /// Number of later events that events() lacks, because it has at most RunEvents::kMost events.
  std::size_t events_left_out() const { return events_.left_out(); }

 private:
  // Place of a message in the file; size 0: the log lacks the message.
  struct Place {
    std::uint64_t offset : 44 = 0;
    std::uint64_t size : 20 = 0;
  };
  using Row = std::array<Place, log::kStepChannels>;

  void ReadRun(const std::filesystem::path& file, std::optional<std::int64_t> run_id);
  void ReadPlaces();
  void Take(const log::Event& event);
  void TakeStep(std::size_t row, runtime::Bytes data);
  runtime::Bytes At(const Place& place) const {
    return reader_.content().subspan(place.offset, place.size);
  }
  /// Removes the signature from `data` if the run is signed. @return the place of `data`; size 0 if
  /// the message does not belong to the run, or is too large
  Place PlaceOf(runtime::Bytes& data) const;
  void FindEvents();

  log::EventLogReader reader_;
  log::RunLog run_;
  RunEvents events_;
  std::vector<Row> rows_;  // by step
  std::array<std::vector<Place>, kNumChannels> control_;
  std::int64_t first_ = 0;
  std::int64_t messages_ = 0;
  std::int64_t read_ = 0;   // number of events that have been read
  std::size_t guess_ = 0;   // probable row of the next event
  bool is_signed_ = false;  // whether the run's messages are signed
  bool knows_run_ = false;  // whether a RUN message of the run has come
};

}  // namespace fogline::web
