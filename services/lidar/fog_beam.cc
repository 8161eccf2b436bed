#include "services/lidar/fog_beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/minima.hpp>

namespace fogline::lidar {
namespace {

using std::numbers::pi;

constexpr double kSpeedOfLight_mps = 299'792'458.0;
constexpr double kSecondsPerNanosecond = 1e-9;

// kQuadratureNodes is the number of nodes for each smooth piece of the integrand. A precision of
// 2^-14 in r* gives 2^-28 in J, because the slope of J is 0 at r*.
constexpr unsigned kQuadratureNodes = 20;
constexpr int kPeakBits = 14;

// The integral of J (fog_beam.h) for R' = `end_m`: the sin^2 pulse folded with g. The integral has
// two pieces, because g has a kink at R2.
double FoldedPulse(const BeamOptics& optics, double extinction_pm, double end_m) {
  const auto integrand = [&](double r) {
    const double wave = std::sin(pi * (end_m - r) / optics.pulse_length_m);
    return wave * wave * ChannelGain(optics, extinction_pm, r);
  };
  const double begin_m = std::max(end_m - optics.pulse_length_m, optics.overlap_start_m);
  const double kink_m = std::clamp(optics.overlap_end_m, begin_m, end_m);
  using Quadrature = boost::math::quadrature::gauss<double, kQuadratureNodes>;
  double sum = 0.0;
  if (kink_m > begin_m) sum += Quadrature::integrate(integrand, begin_m, kink_m);
  if (end_m > kink_m) sum += Quadrature::integrate(integrand, kink_m, end_m);
  return sum;
}

// Range at which g is largest: the r with d/dr ln g = 1 / (r - R1) - 2 / r - 2 alpha = 0, but at
// most R2. The root of 2 alpha r^2 + (1 - 2 alpha R1) r - 2 R1 = 0 is computed in a form that is
// also valid for alpha = 0.
double StrongestGainRange(const BeamOptics& optics, double extinction_pm) {
  const double start_m = optics.overlap_start_m;
  const double b = 1.0 - 2.0 * extinction_pm * start_m;
  const double root = std::sqrt(b * b + 16.0 * extinction_pm * start_m);
  return std::min(4.0 * start_m / (b + root), optics.overlap_end_m);
}

}  // namespace

BeamOptics OpticsOf(const LidarBeamSection& beam) {
  return {.pulse_length_m = kSpeedOfLight_mps * beam.pulse_half_width_ns * kSecondsPerNanosecond,
          .overlap_start_m = beam.overlap_start_m,
          .overlap_end_m = std::max(beam.overlap_start_m, beam.overlap_end_m)};
}

double Overlap(const BeamOptics& optics, double range_m) {
  if (range_m <= optics.overlap_start_m) return 0.0;
  if (range_m >= optics.overlap_end_m) return 1.0;
  return (range_m - optics.overlap_start_m) / (optics.overlap_end_m - optics.overlap_start_m);
}

double ChannelGain(const BeamOptics& optics, double extinction_pm, double range_m) {
  return Overlap(optics, range_m) * std::exp(-2.0 * extinction_pm * range_m) / (range_m * range_m);
}

FogPeak FindFogPeak(const BeamOptics& optics, double extinction_pm) {
  // g has one maximum. g folded with the pulse has one maximum, too. The folded pulse rises until
  // the front of the pulse reaches the maximum of g. It falls after the end of the pulse has passed
  // this maximum. So the maximum of the folded pulse lies between these two positions.
  const double from_m = StrongestGainRange(optics, extinction_pm);
  const auto negative = [&](double end_m) { return -FoldedPulse(optics, extinction_pm, end_m); };
  const auto [end_m, value] = boost::math::tools::brent_find_minima(
      negative, from_m, from_m + optics.pulse_length_m, kPeakBits);
  return {.strength_pm = -value, .range_m = end_m - 0.5 * optics.pulse_length_m};
}

double Beta2And20(double u, double v) {
  return 1.0 - std::exp(std::log(u) / 21.0 + std::log(v) / 20.0);
}

}  // namespace fogline::lidar
