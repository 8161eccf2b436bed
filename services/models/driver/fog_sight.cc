#include "services/models/driver/fog_sight.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/math/special_functions/lambert_w.hpp>

#include "services/visibility.h"

namespace fogline::models {

FogSight::FogSight(const FogSightParameters& parameters) : parameters_(parameters) {
  const FogSightParameters& p = parameters;
  const bool valid =
      p.contrast <= 1.0 && p.contrast_threshold > 0.0 && p.contrast_threshold < p.contrast &&
      p.clear_share >= 0.0 && p.clear_share <= 1.0 && p.lamp_distance_factor >= 1.0 &&
      p.lamp_intensity_cd > 0.0 && p.illuminance_threshold_lx > 0.0 &&
      p.angular_rate_threshold_radps >= 0.0 && p.body_width_m > 0.0 && p.lamp_separation_m > 0.0;
  if (!valid) throw std::invalid_argument("fog sight: a parameter is out of its range");
}

double FogSight::OutlineRange(double visibility_m) const {
  return std::log(parameters_.contrast / parameters_.contrast_threshold) /
         ExtinctionOf(visibility_m);
}

double FogSight::LampRange(double visibility_m) const {
  const double clear_m =
      std::sqrt(parameters_.lamp_intensity_cd / parameters_.illuminance_threshold_lx);
  const double half_extinction_pm = 0.5 * ExtinctionOf(visibility_m);
  if (half_extinction_pm == 0.0) return clear_m;
  return boost::math::lambert_w0(half_extinction_pm * clear_m) / half_extinction_pm;
}

Seen FogSight::At(double gap_m, double visibility_m) const {
  if (gap_m <= OutlineRange(visibility_m)) return Seen::kOutline;
  return gap_m <= LampRange(visibility_m) ? Seen::kLamps : Seen::kNothing;
}

Situation FogSight::Perceive(const Situation& truth, double visibility_m) const {
  Situation perceived = truth;
  if (!truth.ahead) return perceived;
  const double gap_m = truth.ahead->gap_m;
  const Seen seen = At(gap_m, visibility_m);
  if (seen == Seen::kNothing) {
    perceived.ahead.reset();
    return perceived;
  }
  CarAhead& ahead = *perceived.ahead;
  const double width_m =
      seen == Seen::kOutline ? parameters_.body_width_m : parameters_.lamp_separation_m;
  const double seen_growth = width_m * std::abs(truth.speed_mps - ahead.speed_mps);
  if (seen_growth <= parameters_.angular_rate_threshold_radps * gap_m * gap_m) {
    ahead.speed_mps = truth.speed_mps;
    ahead.acceleration_mps2 = 0.0;
  }
  const double vague_to_m = OutlineRange(visibility_m);
  const double clear_to_m = parameters_.clear_share * vague_to_m;
  if (gap_m > clear_to_m) {
    const double share = std::min(1.0, (gap_m - clear_to_m) / (vague_to_m - clear_to_m));
    ahead.gap_m *= 1.0 + share * (parameters_.lamp_distance_factor - 1.0);
  }
  return perceived;
}

}  // namespace fogline::models
