#include "services/radar/radar.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/radar/attenuation.h"

namespace fogline::radar {
namespace {

// At 77 GHz the attenuations of the two polarisations differ by less than 5 %. The radar always has
// horizontal polarisation, which has the larger attenuation.
constexpr Polarization kPolarization = Polarization::kHorizontal;

}  // namespace

Radar::Radar(const Scenario& scenario)
    : radar_(scenario.radar),
      random_(scenario.seed, Stream::kRadar),
      noise_(random_, kNoiseDraw, scenario.steps),
      fog_attenuates_(HasVisibility(scenario.fog.model)),
      fog_coefficient_(FogCoefficient(radar_.frequency_ghz, radar_.temperature_c)),
      rain_dbpkm_(RainAttenuation_dbpkm(scenario.fog.rain_mmph,
                                        RainCoefficientsOf(radar_.frequency_ghz, kPolarization))),
      rainy_max_range_m_(MaxRange_m(radar_.max_range_m, rain_dbpkm_)) {}

void Radar::Restart(const Scenario& scenario) {
  Radar other(scenario);
  other.noise_.Keep(noise_);
  *this = std::move(other);
}

const radar_t& Radar::Step(const truth_t& truth) {
  output_ = {};
  output_.header = truth.header;
  // If the cars have collided, the gap is negative. The radar then measures a gap of 0.
  const double x = std::max(truth.host_gap_m, 0.0);
  const double r = std::sqrt(x * x + radar_.lateral_offset_m * radar_.lateral_offset_m);
  if (r > MaxRange(truth) || DropsOut(truth.header.step)) return output_;

  const double closing_share = r > 0.0 ? x / r : 1.0;  // cosine of the angle to the lane
  const double rate_mps = closing_share * (truth.preceding_speed_mps - truth.host_speed_mps);
  const auto [range_noise, rate_noise] = noise_.At(truth.header.step);
  output_.valid = true;
  output_.range_m = std::max(0.0, r + radar_.bias_m + radar_.range_std_m * range_noise);
  output_.range_rate_mps = rate_mps + radar_.range_rate_std_mps * rate_noise;
  output_.range_std_m = radar_.range_std_m;
  output_.range_rate_std_mps = radar_.range_rate_std_mps;
  return output_;
}

double Radar::MaxRange(const truth_t& truth) const {
  if (!fog_attenuates_) return rainy_max_range_m_;
  const double fog_dbpkm = fog_coefficient_ * LiquidWater_gpm3(truth.fog_visibility_m);
  return MaxRange_m(radar_.max_range_m, rain_dbpkm_ + fog_dbpkm);
}

bool Radar::DropsOut(std::int64_t step) const {
  return radar_.dropout_probability > 0.0 &&
         random_.Uniform2(step, kDropoutDraw)[0] < radar_.dropout_probability;
}

}  // namespace fogline::radar
