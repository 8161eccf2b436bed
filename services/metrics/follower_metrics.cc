#include "services/metrics/follower_metrics.h"

#include <algorithm>
#include <cmath>

#include "services/metrics/surrogate.h"

namespace fogline::metrics {

void FollowerAccumulator::Add(const truth_t& truth, const follower_command_t& commands) {
  const std::size_t cars =
      std::min(cars_.size(), static_cast<std::size_t>(std::max(truth.num_followers, 0)));
  const auto judged = static_cast<std::size_t>(std::max(commands.num_followers, 0));
  num_cars_ = std::max(num_cars_, cars);
  double ahead_mps = truth.host_speed_mps;
  for (std::size_t i = 0; i < cars; ++i) {
    Car& car = cars_[i];
    const double gap_m = truth.follower_gap_m[i];
    const double speed_mps = truth.follower_speed_mps[i];
    Lower(car.measures.min_gap_m, gap_m);
    const double ttc_s = TimeToCollision({gap_m, speed_mps, ahead_mps});
    if (std::isfinite(ttc_s)) Lower(car.measures.min_ttc_s, ttc_s);
    if (i < judged) {
      AddSafety(truth.fog_present != 0, CompromisedSafety(commands.safe_distance_m[i], gap_m), car);
    }
    ahead_mps = speed_mps;
  }
}

void FollowerAccumulator::AddSafety(bool fog, double compromised_m, Car& car) {
  Raise(car.measures.max_compromised_safety_m, compromised_m);
  if (fog) car.compromised_safety_fog_m.Add(compromised_m);
}

std::vector<FollowerMetrics> FollowerAccumulator::Result() const {
  std::vector<FollowerMetrics> result;
  for (std::size_t i = 0; i < num_cars_; ++i) {
    result.push_back(cars_[i].measures);
    result.back().mean_compromised_safety_fog_m = cars_[i].compromised_safety_fog_m.Value();
  }
  return result;
}

}  // namespace fogline::metrics
