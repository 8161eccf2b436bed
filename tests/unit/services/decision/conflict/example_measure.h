// services/decision/conflict/one_step/relative.h: how much of the radar's range the LiDAR misses.
#pragma once

#include <algorithm>

#include "services/decision/conflict/conflict_measure.h"
#include "services/decision/conflict/conflict_parameters.h"

namespace fogline::conflict {

/// max(0, radar - LiDAR)/radar, in [0, 1]. A missing value holds the last score.
class Relative final : public ConflictMeasure {
 public:
  explicit Relative(const ConflictParameters&) {}

  double Step(const Evidence& evidence) override {
    const auto& [radar, lidar, prediction] = evidence;
    if (radar.valid && lidar.valid && radar.range_m > 0) {
      score_ = std::clamp(1 - lidar.range_m / radar.range_m, 0.0, 1.0);
    }
    return score_;
  }
  void Reset() override { score_ = 0; }

 private:
  double score_ = 0;
};

}  // namespace fogline::conflict
