// Measures how punctual a role is in a run in real time, and writes the results into STATUS.
#pragma once

#include <cstdint>
#include <string_view>

#include "common/clock.h"
#include "services/runtime/realtime/duration_histogram.h"
#include "services/runtime/realtime/input_health.h"

namespace fogline {
class status_t;
}  // namespace fogline

namespace fogline::runtime {

/// The statistics of one role: ticks and latency. A tick is the beginning of a step. A tick of the
/// world is due when a period begins. A tick of another role is due when the last needed input
/// arrives, or at the role's deadline. The latency of a step begins when the world has sent the
/// TRUTH of this step. It ends when the HOST_COMMAND of this step reaches the world. Both times are
/// on the world's clock, so the clocks of two machines are never compared.
class RealtimeStatistics {
 public:
  /// A tick counts as late if it comes more than this time after its due time.
  static constexpr Duration kLate = milliseconds(5);

  /// Counts a tick that was due at `due` and happened at `now`.
  void Tick(TimePoint due, TimePoint now);
  /// Counts the latency of a step.
  void Latency(Duration duration) { latency_.Add(duration); }
  /// Counts a step that was left out, or was computed although an input was missing.
  void Miss() { ++deadline_misses_; }

  std::int64_t ticks() const { return jitter_.count(); }
  std::int64_t ticks_late() const { return ticks_late_; }
  std::int64_t deadline_misses() const { return deadline_misses_; }
  /// The absolute difference between the time of a tick and its due time.
  const DurationHistogram& jitter() const { return jitter_; }

  /// Writes all figures into a STATUS.
  void Write(status_t& status) const;

 private:
  DurationHistogram jitter_;
  DurationHistogram latency_;
  std::int64_t ticks_late_ = 0;
  std::int64_t deadline_misses_ = 0;
};

/// Removes the inputs from a STATUS, before they are written again.
void ClearInputs(status_t& status);
/// Adds an input to a STATUS.
void WriteInput(std::string_view channel, const InputHealth& health, TimePoint now,
                status_t& status);

}  // namespace fogline::runtime
