// How well a role keeps its time in a run in real time, and how that stands in STATUS.
#pragma once

#include <cstdint>
#include <string_view>

#include "services/runtime/clock.h"
#include "services/runtime/duration_histogram.h"
#include "services/runtime/input_health.h"

namespace fogline {

class status_t;

/// A tick is the moment at which a step is to be computed: the period's beginning at the world, an
/// input's arrival elsewhere. Latency goes from sensor to command: from when the world has sent a
/// step's TRUTH to when that step's HOST_COMMAND is back there, on one clock, so that no two hosts'
/// clocks are compared.
class RealtimeStatistics {
 public:
  /// Later than this is counted as late.
  static constexpr Duration kLate = milliseconds(5);

  /// A tick that was due then and happened now.
  void Tick(TimePoint due, TimePoint now);
  /// A step's command came back after so long.
  void Latency(Duration duration) { latency_.Add(duration); }
  /// A step had to go without an input that should have been there.
  void Miss() { ++deadline_misses_; }

  std::int64_t ticks() const { return jitter_.count(); }
  std::int64_t ticks_late() const { return ticks_late_; }
  std::int64_t deadline_misses() const { return deadline_misses_; }
  /// How far from its due time a tick was, either way.
  const DurationHistogram& jitter() const { return jitter_; }
  const DurationHistogram& latency() const { return latency_; }

  /// Writes everything into a STATUS.
  void Write(status_t& status) const;

 private:
  DurationHistogram jitter_;
  DurationHistogram latency_;
  std::int64_t ticks_late_ = 0;
  std::int64_t deadline_misses_ = 0;
};

/// Takes the inputs out of a STATUS, before they are written anew.
void ClearInputs(status_t& status);
/// Adds an input.
void WriteInput(std::string_view channel, const InputHealth& health, TimePoint now,
                status_t& status);

}  // namespace fogline
