// Which run a live view shows, and its events: found in the messages of the network, without
// sending any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/clock.h"
#include "services/runtime/wire/scenario_parts.h"
#include "services/runtime/wire/wire.h"
#include "tools/web/run_events.h"
#include "tools/web/view_messages.h"

namespace fogline::web {

/// Follows one run until it has ended or has been silent for kSilent. Then it takes the next run
/// that it hears. The scenario of a run comes in parts; a run is shown when all of them are there.
class RunTracker {
 public:
  static constexpr Duration kSilent = milliseconds(2000);
  /// The most parts of a scenario: about 4 MB of text. A page could not use more.
  static constexpr std::int32_t kMostParts = 4096;

  RunTracker() = default;
  /// @param only follows this run and no other
  explicit RunTracker(std::optional<std::int64_t> only) : run_id_(only), only_(only) {}

  /// Takes a message. @param channel its place in kChannels
  void Hear(std::size_t channel, runtime::Bytes bytes, TimePoint now);

  /// The run that is followed; nullopt before the first one.
  std::optional<std::int64_t> followed() const { return run_id_; }
  /// The run whose scenario is known; nullopt if there is none.
  const std::optional<RunFacts>& run() const { return shown_; }
  /// RunText() of run(); "" if there is none.
  const std::string& run_text() const { return shown_text_; }
  /// Grows by one with each new run().
  std::int64_t runs() const { return runs_; }
  /// Complete scenarios that are no JSON objects. Their runs are not shown.
  std::int64_t refused_scenarios() const { return refused_scenarios_; }
  /// The events of the run so far.
  const std::vector<RunEvent>& events() const { return events_.events(); }
  /// The events since the last call. They begin again with each new run(), and when a run is played
  /// again.
  std::vector<RunEvent> TakeEvents();

 private:
  void HearRun(runtime::Bytes bytes, TimePoint now);
  void HearStep(std::size_t channel, runtime::Bytes bytes);
  void Begin(const run_t& run);
  void Show(RunFacts run);
  void ForgetEvents();

  std::optional<std::int64_t> run_id_;
  std::optional<std::int64_t> only_;
  TimePoint heard_{};
  bool stopped_ = false;
  runtime::ScenarioParts parts_;
  std::optional<RunFacts> shown_;
  std::string shown_text_;
  std::int64_t runs_ = 0;
  std::int64_t refused_scenarios_ = 0;
  RunEvents events_;
  std::size_t taken_ = 0;     // events that TakeEvents() has returned
  std::int64_t newest_ = -1;  // step
  truth_t truth_{};
  arbitration_t command_{};
  driver_command_t driver_{};
  bool offered_ = false;  // driver_ has a message of this run
};

}  // namespace fogline::web
