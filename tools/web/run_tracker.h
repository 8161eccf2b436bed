// Finds out which run a live view shows, and the events of this run. It uses only messages of the
// network, and sends none.
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

/// Follows one run until it has ended, has been silent for kSilent, or its network is heard no
/// more. Then follows the next run whose RUN comes. The scenario of a run comes in parts. A run is
/// shown when all parts have come.
class RunTracker {
 public:
  static constexpr Duration kSilent = milliseconds(2000);
  /// Limit for the parts of a scenario: about 4 MB of text. A page could not handle more.
  static constexpr std::int32_t kMostParts = 4096;

  RunTracker() = default;
  /// @param only the only run to follow; nullopt: any run
  explicit RunTracker(std::optional<std::int64_t> only) : run_id_(only), only_(only) {}

  /// Takes a message. @param channel index of the channel in kChannels
  void Hear(std::size_t channel, runtime::Bytes bytes, TimePoint now);

  /// Notes that the network of an announced run is heard no more. If the followed run was there,
  /// the tracker follows the next run whose RUN comes. If the RUN of the followed run comes again,
  /// the tracker stays with it.
  void LeaveNetwork() { left_ = true; }

  /// The followed run; nullopt before the first run.
  std::optional<std::int64_t> followed() const { return run_id_; }
  /// The last run whose scenario is complete; nullopt if there is none.
  const std::optional<RunFacts>& run() const { return shown_; }
  /// RunText() of run(); "" if run() is nullopt.
  const std::string& run_text() const { return shown_text_; }
  /// Number of runs that run() has shown so far.
  std::int64_t runs() const { return runs_; }
  /// Number of complete scenarios that are not JSON objects. Their runs are not shown.
  std::int64_t refused_scenarios() const { return refused_scenarios_; }
  /// The events of the followed run so far.
  const std::vector<RunEvent>& events() const { return events_.events(); }
  /// Number of later events that events() lacks, because it has at most RunEvents::kMost events.
  std::size_t events_left_out() const { return events_.left_out(); }
  /// The events since the last call. After a new run has begun, or a run is played again, the list
  /// begins with the first event of this run. When all parts of the scenario have come, all events
  /// of the run come once more, because their texts may depend on the scenario.
  std::vector<RunEvent> TakeEvents();

 private:
  void HearRun(runtime::Bytes bytes, TimePoint now);
  /// Notes that a message of the followed run has come.
  void NoteLife(TimePoint now);
  void HearStep(std::size_t channel, runtime::Bytes bytes);
  void Begin(const run_t& run);
  void Show(RunFacts run);
  void ForgetEvents();

  std::optional<std::int64_t> run_id_;
  std::optional<std::int64_t> only_;
  TimePoint heard_{};
  bool stopped_ = false;
  bool left_ = false;  // whether LeaveNetwork() was called after the last RUN of the followed run
  // Whether an old step means that the run is being played again. This is the case after the end of
  // the run, and after a silence of all its processes. Otherwise an old step is a repair: a role
  // that was started again asks for all steps from the first one on.
  bool may_begin_again_ = false;
  bool realtime_ = false;  // whether the followed run is in real time
  runtime::ScenarioParts parts_;
  std::optional<RunFacts> shown_;
  std::string shown_text_;
  std::int64_t runs_ = 0;
  std::int64_t refused_scenarios_ = 0;
  PersonSection person_;  // of the followed run; defaults before its valid scenario has come
  RunEvents events_;
  std::size_t taken_ = 0;     // number of events that TakeEvents() has returned
  std::int64_t newest_ = -1;  // newest step
  truth_t truth_{};
  arbitration_t command_{};
  driver_command_t driver_{};
  bool offered_ = false;  // whether driver_ has a message of this run
};

}  // namespace fogline::web
