#include "services/metrics/averaged_jerk.h"

#include <cmath>

#include "services/metrics/running.h"

namespace fogline::metrics {
namespace {

constexpr double kWindow_s = 1.0;

}  // namespace

void AveragedJerk::DropOldest() {
  begin_ = (begin_ + 1) % kMostPoints;
  --count_;
  dropped_ = true;
}

// The acceleration of a point was applied from the time of the previous point to the time of this
// point. So a(t - 1 s) is the acceleration of the first point at or after t - 1 s.
std::optional<double> AveragedJerk::Add(double time_s, double acceleration_mps2) {
  if (count_ == kMostPoints) DropOldest();
  points_[(begin_ + count_) % kMostPoints] = {time_s, acceleration_mps2};
  ++count_;
  const double since_s = time_s - kWindow_s;
  while (Oldest().time_s < since_s - kSameTime_s) DropOldest();
  const bool known = dropped_ || Oldest().time_s <= since_s + kSameTime_s;
  if (!known) return std::nullopt;
  return std::abs(acceleration_mps2 - Oldest().acceleration_mps2) / kWindow_s;
}

}  // namespace fogline::metrics
