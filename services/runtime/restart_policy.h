// When a role that has died is started again: soon, ever later while that does not help, and at
// most so many times in a run.
#pragma once

#include <algorithm>
#include <optional>

#include "services/runtime/clock.h"

namespace fogline {

class RestartPolicy {
 public:
  /// How long to wait before a restart: this long, twice as long each time, at most so long (the
  /// figures of procman, LCM's process manager).
  static constexpr Duration kShortest = milliseconds(10);
  static constexpr Duration kLongest = milliseconds(1000);

  /// @param limit restarts in one run
  explicit RestartPolicy(int limit) : limit_(limit) {}

  /// The role has died when the run was at this step.
  /// @return how long to wait before it is started again; nothing if it is not
  std::optional<Duration> OnDeath(std::int64_t step) {
    if (restarts_ >= limit_) return std::nullopt;
    const bool helped = restarts_ == 0 || step > step_;
    wait_ = helped ? kShortest : std::min(2 * wait_, kLongest);
    step_ = step;
    ++restarts_;
    return wait_;
  }

  /// It could not be started. @return how long to wait before the next try, which is no restart
  /// more: that ends with the run's stall timeout
  Duration OnFailedStart() { return wait_ = std::min(2 * wait_, kLongest); }

  int restarts() const { return restarts_; }
  int limit() const { return limit_; }

 private:
  int limit_;
  int restarts_ = 0;
  std::int64_t step_ = -1;  // at the last death
  Duration wait_{};
};

}  // namespace fogline
