#include "services/runtime/realtime/input_health.h"

#include <algorithm>

namespace fogline::runtime {
namespace {

Duration Periods(double periods, Duration period) {
  return duration_cast<Duration>(periods * period);
}

}  // namespace

InputHealth::InputHealth(const HealthSection& section, Duration period, TimePoint began)
    : stale_(Periods(section.stale_periods, period)),
      lost_(std::max(stale_, Periods(section.lost_periods, period))),
      recover_steps_(section.recover_steps),
      // From the first to the last of n steps, n - 1 periods pass. If the first step came late,
      // this time is shorter by the delay. The delay is stale_periods - 1 periods at most, so the
      // least time is n - stale_periods periods.
      recover_time_(std::max(
          Duration::zero(),
          Periods(static_cast<double>(section.recover_steps) - section.stale_periods, period))),
      heard_(began),
      streak_began_(began) {}

void InputHealth::Arrived(std::int64_t step, TimePoint now) {
  if (step <= newest_) {
    if (step < newest_) ++late_;
    return;
  }
  const bool first = newest_ < 0;
  const bool in_time = Age(now) <= stale_;
  Update(now);
  newest_ = step;
  heard_ = now;
  arrivals_[next_arrival_] = now;
  next_arrival_ = (next_arrival_ + 1) % kRateSteps;
  num_arrivals_ = std::min(num_arrivals_ + 1, kRateSteps);

  if (first || !in_time) {
    streak_ = 0;
    streak_began_ = now;
  }
  ++streak_;
  if (state_ == InputState::kAwaited) {
    state_ = InputState::kOk;
  } else {
    Recover(now);
  }
}

void InputHealth::Recover(TimePoint now) {
  if (streak_ >= recover_steps_ && now - streak_began_ >= recover_time_) state_ = InputState::kOk;
}

InputState InputHealth::Update(TimePoint now) {
  const Duration age = Age(now);
  if (age > lost_) {
    state_ = InputState::kLost;
  } else if (age > stale_ && state_ == InputState::kOk) {
    state_ = InputState::kStale;
  }
  return state_;
}

TimePoint InputHealth::NextChange() const {
  // An age equal to the limit is still allowed, so the state changes one tick of the clock later.
  switch (state_) {
    case InputState::kOk:
      return heard_ + stale_ + Duration(1);
    case InputState::kAwaited:
    case InputState::kStale:
      return heard_ + lost_ + Duration(1);
    case InputState::kLost:
      break;
  }
  return TimePoint::max();
}

double InputHealth::RateHz(TimePoint now) const {
  if (num_arrivals_ < 2) return 0;
  const std::size_t first = num_arrivals_ < kRateSteps ? 0 : next_arrival_;
  const TimePoint oldest = arrivals_[first];
  const auto intervals = static_cast<double>(num_arrivals_ - 1);
  // An interval between two arrivals is closed. The interval since the last arrival is still open.
  // It counts as soon as it is longer than the average of the closed intervals.
  const double closed_s = Seconds(heard_ - oldest) / intervals;
  const double open_s = Seconds(now - oldest) / (intervals + 1);
  const double interval_s = std::max(closed_s, open_s);
  return interval_s > 0 ? 1 / interval_s : 0;
}

}  // namespace fogline::runtime
