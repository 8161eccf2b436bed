// How often messages of one kind arrive: count, rate, jitter, bandwidth. Fed with times and sizes.
#pragma once

#include <cstdint>
#include <optional>

#include "services/runtime/clock.h"

namespace fogline {

/// What is known of arrivals at the end of an interval of observation.
struct ArrivalView {
  std::int64_t messages = 0;            // since the first
  double rate_hz = 0;                   // messages of the interval / its length
  double bandwidth_bytes_per_s = 0;     // payload: without what LCM, UDP and IP add
  std::optional<double> jitter_s;       // of the interval; none below three arrivals
  std::optional<double> longest_gap_s;  // of the interval; none below two arrivals
  double age_s = 0;                     // since the last message
};

/// Counts arrivals, interval by interval. Jitter is the sample standard deviation of the times
/// between successive arrivals, computed by
/// the recurrence of Welford (Technometrics 4, 1962).
/// It needs no clock of the sender, which RFC 3550's interarrival jitter would: a paced run and a
/// log that is played fast have none that runs like ours.
class Arrivals {
 public:
  void Add(std::size_t bytes, TimePoint now);

  /// Ends an interval of observation and begins the next. @param interval its length
  ArrivalView Observe(TimePoint now, Duration interval);

  TimePoint last() const { return last_; }

 private:
  std::int64_t messages_ = 0;
  TimePoint last_{};
  // Of the interval:
  std::int64_t new_messages_ = 0;
  std::int64_t new_bytes_ = 0;
  std::int64_t gaps_ = 0;  // times between arrivals whose second one is in the interval
  double mean_gap_s_ = 0;
  double sum_of_squares_ = 0;  // of deviations from the mean
  double longest_gap_s_ = 0;
};

}  // namespace fogline
