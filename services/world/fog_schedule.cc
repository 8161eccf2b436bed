#include "services/world/fog_schedule.h"

#include <cmath>
#include <numbers>

#include "services/graph.h"
#include "services/visibility.h"

namespace fogline::world {
double FogLevel(FogProfile profile, double x) {
  using std::numbers::pi;
  switch (profile) {
    case FogProfile::kBox:
      return 1.0;
    case FogProfile::kHalfSine:
      return std::sin(pi * x);
    case FogProfile::kRaisedCosine:
      return 0.5 * (1.0 - std::cos(2.0 * pi * x));
    case FogProfile::kTriangle:
      return 1.0 - std::abs(2.0 * x - 1.0);
  }
  return 0.0;
}

FogSchedule::FogSchedule(const FogSection& fog)
    : fog_(fog),
      start_us_(std::llround(fog.start_s * kMicrosPerSecond)),
      duration_us_(std::llround(fog.duration_s * kMicrosPerSecond)) {}

Fog FogSchedule::At(std::int64_t utime) const {
  const std::int64_t since_us = utime - start_us_;
  if (fog_.model == FogModel::kNone || since_us < 0 || since_us >= duration_us_) {
    return {.present = false, .level = 0.0, .visibility_m = fog_.clear_visibility_m};
  }
  const double x = static_cast<double>(since_us) / static_cast<double>(duration_us_);
  Fog fog{
      .present = true, .level = FogLevel(fog_.profile, x), .visibility_m = fog_.clear_visibility_m};
  if (HasVisibility(fog_.model)) {
    const double clear_pm = ExtinctionOf(fog_.clear_visibility_m);
    const double dense_pm = ExtinctionOf(fog_.visibility_m);
    fog.visibility_m = VisibilityOf(clear_pm + fog.level * (dense_pm - clear_pm));
  }
  return fog;
}

}  // namespace fogline::world
