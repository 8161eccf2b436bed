// Decides when a role whose process has ended is started again. The first restart comes after 10
// ms. If the run makes no progress after a restart, the wait before the next restart is longer. The
// number of restarts in a run is limited.
#pragma once

#include <algorithm>
#include <optional>

#include "common/clock.h"

namespace fogline::runtime {

class RestartPolicy {
 public:
  /// The shortest and the longest wait before a restart. The wait doubles with each restart after
  /// which the run makes no progress. The values are those of procman, a process manager for LCM
  /// systems.
  static constexpr Duration kShortest = milliseconds(10);
  static constexpr Duration kLongest = milliseconds(1000);

  /// @param limit the largest number of restarts of the role in one run
  explicit RestartPolicy(int limit) : limit_(limit) {}

  /// Notes that the role's process has ended while the run was at this step.
  /// @return how long to wait before the restart; nullopt if the role has had all its restarts
  std::optional<Duration> OnDeath(std::int64_t step) {
    if (restarts_ >= limit_) return std::nullopt;
    const bool helped = restarts_ == 0 || step > step_;
    wait_ = helped ? kShortest : std::min(2 * wait_, kLongest);
    step_ = step;
    ++restarts_;
    return wait_;
  }

  /// Notes that a process for the role could not be started, or has ended by itself before its
  /// first STATUS. A failed try does not count as a restart. The tries end when the run's stall
  /// timeout ends the run.
  /// @return how long to wait before the next try
  Duration OnFailedStart() { return wait_ = std::min(2 * wait_, kLongest); }

  int restarts() const { return restarts_; }
  int limit() const { return limit_; }

 private:
  int limit_;
  int restarts_ = 0;
  std::int64_t step_ = -1;  // step of the run at the last death
  Duration wait_{};
};

}  // namespace fogline::runtime
