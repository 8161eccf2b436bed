// A step gate says when the role that begins the steps (the world) may begin the next step. The
// runner must have said GO, and the step must be due at the run's pace. The step may be at most
// kMaxAhead steps ahead of the recorder's log on disk, and must not come after the run's last step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "common/clock.h"
#include "scenario/sections/scenario.h"
#include "services/runtime/transport/bus.h"
#include "services/runtime/wire/step_ring.h"

namespace fogline::runtime {

class StepGate {
 public:
  /// Listens to the recorder's STATUS on `bus`. Counts refused messages in `own`.
  StepGate(Bus& bus, status_t& own);

  void Configure(const Scenario& scenario, std::int64_t run_id);
  /// Notes that this step has begun in the run, for example in an earlier process of the world.
  void BegunBefore(std::int64_t step) { begun_before_ = std::max(begun_before_, step); }
  void OnGo(const run_t& run, TimePoint now);
  bool started() const { return started_; }

  /// Whether step `step` may begin.
  bool Open(std::int64_t step, TimePoint now) const;
  /// Notes that `step` is the last step of the run.
  void SetFinal(std::int64_t step) { final_ = step; }
  /// Whether the final step has begun and is on disk.
  bool Finished(std::int64_t next) const {
    return final_ && next > *final_ && recorded_ >= *final_;
  }
  /// Whether to request the recorder's STATUS now.
  /// @return the step that must be on disk before step `next` can begin; nullopt if `next` does not
  ///     wait for the recorder, or if no request is due
  std::optional<std::int64_t> WantsRecorded(std::int64_t next, TimePoint now);
  /// The next time at which the result of Open() or WantsRecorded() may change without a new
  /// message.
  TimePoint NextPoll(std::int64_t next, TimePoint now) const;

 private:
  /// The step that must be on disk before `next` can begin (or, at the end, before the run is
  /// done).
  std::int64_t Needed(std::int64_t next) const {
    return final_ && next > *final_ ? *final_ : next - kMaxAhead;
  }
  TimePoint Due(std::int64_t step) const;

  std::int64_t run_id_ = 0;
  double step_s_ = 0;
  bool started_ = false;
  double pace_ = 0;
  TimePoint start_{};
  std::int64_t recorded_ = -1;
  std::int64_t begun_before_ = -1;
  std::optional<std::int64_t> final_;
  std::optional<TimePoint> ask_at_;
  Duration retry_interval_{};
};

}  // namespace fogline::runtime
