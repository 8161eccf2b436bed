// Statistics of the arrivals of messages, for example on one channel: count, rate, jitter,
// bandwidth. The caller passes times and sizes as arguments.
#pragma once

#include <cstdint>
#include <optional>

#include "common/clock.h"

namespace fogline::watch {

/// Statistics of arrivals at the end of an interval of observation. A gap is the time between two
/// successive arrivals.
struct ArrivalView {
  std::int64_t messages = 0;            // number of all messages so far
  double rate_hz = 0;                   // messages in the interval, divided by its length
  double bandwidth_bytes_per_s = 0;     // payload only: without the bytes that LCM, UDP and IP add
  std::optional<double> jitter_s;       // of the gaps that end in the interval; needs two gaps
  std::optional<double> longest_gap_s;  // longest gap that ends in the interval; nullopt if none
  double age_s = 0;                     // time since the last message
};

/// Counts arrivals, interval by interval. Jitter is the sample standard deviation of the times
/// between successive arrivals, computed by the recurrence of Welford (Technometrics 4, 1962). The
/// interarrival jitter of RFC 3550 is not used, because it needs a clock of the sender that is as
/// fast as the receiver's clock. A paced run, and a log that is played fast, have no such clock.
class Arrivals {
 public:
  void Add(std::size_t bytes, TimePoint now);

  /// Ends an interval of observation and begins the next interval.
  /// @param interval length of the ended interval
  ArrivalView Observe(TimePoint now, Duration interval);

  TimePoint last() const { return last_; }

 private:
  std::int64_t messages_ = 0;
  TimePoint last_{};
  // The members below are counts of the interval.
  std::int64_t new_messages_ = 0;
  std::int64_t new_bytes_ = 0;
  std::int64_t gaps_ = 0;  // number of gaps whose second arrival is in the interval
  double mean_gap_s_ = 0;
  double sum_of_squares_ = 0;  // sum of squared deviations from the mean
  double longest_gap_s_ = 0;
};

}  // namespace fogline::watch
