#include "services/measures/follower_measures.h"

#include <algorithm>

namespace fogline {
namespace {

void Lower(std::optional<double>& least, double value) {
  if (!least || value < *least) least = value;
}

void Raise(std::optional<double>& most, double value) {
  if (!most || value > *most) most = value;
}

}  // namespace

void FollowerAccumulator::Add(const truth_t& truth, const follower_command_t& commands) {
  const std::size_t cars =
      std::min(cars_.size(), static_cast<std::size_t>(std::max(truth.num_followers, 0)));
  const auto judged = static_cast<std::size_t>(std::max(commands.num_followers, 0));
  num_cars_ = std::max(num_cars_, cars);
  double ahead_mps = truth.host_speed_mps;
  for (std::size_t i = 0; i < cars; ++i) {
    Car& car = cars_[i];
    const double gap_m = truth.follower_gap_m[i];
    const double closing_mps = truth.follower_speed_mps[i] - ahead_mps;
    Lower(car.measures.min_gap_m, gap_m);
    if (closing_mps > 0) Lower(car.measures.min_ttc_s, std::max(gap_m, 0.0) / closing_mps);
    if (i < judged) AddSafety(truth.fog_present != 0, commands.safe_distance_m[i] - gap_m, car);
    ahead_mps = truth.follower_speed_mps[i];
  }
}

void FollowerAccumulator::AddSafety(bool fog, double shortfall_m, Car& car) {
  const double compromised_m = std::max(shortfall_m, 0.0);
  Raise(car.measures.max_compromised_safety_m, compromised_m);
  if (!fog) return;
  car.sum_fog_m += compromised_m;
  ++car.steps_fog;
}

std::vector<FollowerMeasures> FollowerAccumulator::Result() const {
  std::vector<FollowerMeasures> result;
  for (std::size_t i = 0; i < num_cars_; ++i) {
    const Car& car = cars_[i];
    result.push_back(car.measures);
    if (car.steps_fog == 0) continue;
    result.back().mean_compromised_safety_fog_m =
        car.sum_fog_m / static_cast<double>(car.steps_fog);
  }
  return result;
}

}  // namespace fogline
