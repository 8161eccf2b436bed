// Time of CLOCK_MONOTONIC, a clock that cannot be set. This time is used for waits, for the repair
// of lost messages, and for runs in real time. No result of a run in lockstep may depend on this
// time.
#pragma once

#include <chrono>

namespace fogline {

using Clock = std::chrono::steady_clock;
using Duration = Clock::duration;
using TimePoint = Clock::time_point;
using std::chrono::duration_cast;
using std::chrono::milliseconds;

/// A duration in seconds.
inline double Seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

/// Whole milliseconds of a duration.
inline std::int64_t Milliseconds(Duration duration) {
  return duration_cast<milliseconds>(duration).count();
}

}  // namespace fogline
