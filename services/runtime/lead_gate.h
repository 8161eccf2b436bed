// When the role that begins the steps (the world) may begin one: not before the runner's GO, not
// faster than the pace, not more than kMaxAhead steps ahead of what the recorder has on disk, not
// after the end.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "scenario/scenario.h"
#include "services/runtime/bus.h"
#include "services/runtime/clock.h"
#include "services/runtime/step_ring.h"

namespace fogline {

class LeadGate {
 public:
  /// Listens to the recorder's STATUS on `bus`; what it refuses counts in `own`.
  LeadGate(Bus& bus, status_t& own);

  void Configure(const Scenario& scenario, std::int64_t run_id);
  /// This step has begun, by a world that was there before this one.
  void BegunBefore(std::int64_t step) { begun_before_ = std::max(begun_before_, step); }
  void OnGo(const run_t& run, TimePoint now);
  bool started() const { return started_; }

  /// Whether step `step` may begin.
  bool Open(std::int64_t step, TimePoint now) const;
  /// No step follows `step`.
  void SetFinal(std::int64_t step) { final_ = step; }
  /// The final step has begun and is on disk.
  bool Finished(std::int64_t next) const {
    return final_ && next > *final_ && recorded_ >= *final_;
  }
  /// Step that the recorder should be asked for, if it is the recorder that holds up step `next`.
  std::optional<std::int64_t> WantsRecorded(std::int64_t next, TimePoint now);
  /// When Open() or WantsRecorded() may answer differently without a message.
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
  Duration patience_{};
};

}  // namespace fogline
