#include "tools/watch/arrivals.h"

#include <algorithm>
#include <cmath>

namespace fogline::watch {

void Arrivals::Add(std::size_t bytes, TimePoint now) {
  if (messages_ > 0) {
    const double gap_s = Seconds(now - last_);
    ++gaps_;
    const double deviation_s = gap_s - mean_gap_s_;
    mean_gap_s_ += deviation_s / static_cast<double>(gaps_);
    sum_of_squares_ += deviation_s * (gap_s - mean_gap_s_);
    longest_gap_s_ = std::max(longest_gap_s_, gap_s);
  }
  last_ = now;
  ++messages_;
  ++new_messages_;
  new_bytes_ += static_cast<std::int64_t>(bytes);
}

ArrivalView Arrivals::Observe(TimePoint now, Duration interval) {
  const double interval_s = Seconds(interval);
  ArrivalView view{.messages = messages_, .age_s = Seconds(now - last_)};
  if (interval_s > 0) {
    view.rate_hz = static_cast<double>(new_messages_) / interval_s;
    view.bandwidth_bytes_per_s = static_cast<double>(new_bytes_) / interval_s;
  }
  if (gaps_ >= 1) view.longest_gap_s = longest_gap_s_;
  if (gaps_ >= 2) view.jitter_s = std::sqrt(sum_of_squares_ / static_cast<double>(gaps_ - 1));
  new_messages_ = new_bytes_ = gaps_ = 0;
  mean_gap_s_ = sum_of_squares_ = longest_gap_s_ = 0;
  return view;
}

}  // namespace fogline::watch
