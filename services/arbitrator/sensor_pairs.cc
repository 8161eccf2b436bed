#include "services/arbitrator/sensor_pairs.h"

#include <algorithm>

namespace fogline::arbitrator {

SensorPairs::SensorPairs(const HealthSection& section) : section_(section) {
  for (radar_t& radar : radars_) radar.header.step = -1;
  for (lidar_t& lidar : lidars_) lidar.header.step = -1;
}

InputState SensorPairs::Update(std::int64_t step, const radar_t* radar, const lidar_t* lidar) {
  const auto place = [](std::int64_t s) { return static_cast<std::size_t>(s) % kDepth; };
  if (radar != nullptr) radars_[place(radar->header.step)] = *radar;
  if (lidar != nullptr) lidars_[place(lidar->header.step)] = *lidar;
  if (began_ < 0) began_ = step;
  Match();
  Judge(step);
  return state_;
}

void SensorPairs::Match() {
  for (std::size_t i = 0; i < kDepth; ++i) {
    const std::int64_t step = radars_[i].header.step;
    if (step <= pair_step_ || lidars_[i].header.step != step) continue;
    pair_step_ = step;
    radar_ = radars_[i];
    lidar_ = lidars_[i];
  }
}

// The age of a pair is 0 at the decision of its own step. Until the first pair has come, the age
// counts from the step before the first decision. So the age is 1 at the first decision.
void SensorPairs::Judge(std::int64_t step) {
  const auto age = static_cast<double>(step - (has_pair() ? pair_step_ : began_ - 1));
  const bool in_time = age <= section_.stale_periods;
  in_time_ = in_time && has_pair() ? in_time_ + 1 : 0;
  if (age > std::max(section_.lost_periods, section_.stale_periods)) {
    state_ = InputState::kLost;
  } else if (!has_pair()) {
    return;
  } else if (state_ == InputState::kAwaited || in_time_ >= section_.recover_steps) {
    state_ = InputState::kOk;
  } else if (!in_time && state_ == InputState::kOk) {
    state_ = InputState::kStale;
  }
}

}  // namespace fogline::arbitrator
