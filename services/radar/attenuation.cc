#include "services/radar/attenuation.h"

#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include <boost/math/special_functions/lambert_w.hpp>

namespace fogline::radar {
namespace {

constexpr double kMetresPerKilometre = 1e3;
constexpr double kKelvinAtZeroCelsius = 273.15;

// One term of P.838-3's regression over x = log10 f: height exp(-((x - centre) / width)^2).
struct Bell {
  double height;
  double centre;
  double width;
};

// ITU-R P.838-3, tables 1 to 4.
constexpr std::array kBellsLogKHorizontal{
    Bell{-5.33980, -0.10008, 1.13098}, Bell{-0.35351, 1.26970, 0.45400},
    Bell{-0.23789, 0.86036, 0.15354}, Bell{-0.94158, 0.64552, 0.16817}};
constexpr std::array kBellsLogKVertical{
    Bell{-3.80595, 0.56934, 0.81061}, Bell{-3.44965, -0.22911, 0.51059},
    Bell{-0.39902, 0.73042, 0.11899}, Bell{0.50167, 1.07319, 0.27195}};
constexpr std::array kBellsAlphaHorizontal{
    Bell{-0.14318, 1.82442, -0.55187}, Bell{0.29591, 0.77564, 0.19822},
    Bell{0.32177, 0.63773, 0.13164}, Bell{-5.37610, -0.96230, 1.47828},
    Bell{16.1721, -3.29980, 3.43990}};
constexpr std::array kBellsAlphaVertical{
    Bell{-0.07771, 2.33840, -0.76284}, Bell{0.56727, 0.95545, 0.54039},
    Bell{-0.20238, 1.14520, 0.26809}, Bell{-48.2991, 0.791669, 0.116226},
    Bell{48.5833, 0.791459, 0.116479}};

// Sum of the bells plus the line slope x + offset.
double Regression(std::span<const Bell> bells, double slope, double offset, double x) {
  double sum = slope * x + offset;
  for (const Bell& bell : bells) {
    const double z = (x - bell.centre) / bell.width;
    sum += bell.height * std::exp(-z * z);
  }
  return sum;
}

}  // namespace

double LiquidWater_gpm3(double visibility_m) {
  constexpr double kThickFogWater_gpm3 = 0.5;
  constexpr double kThickFogVisibility_m = 50.0;
  constexpr double kExponent = 1.285;  // ln(0.5 / 0.05) / ln(300 / 50)
  return kThickFogWater_gpm3 * std::pow(kThickFogVisibility_m / visibility_m, kExponent);
}

double FogCoefficient(double frequency_ghz, double temperature_c) {
  const double f = frequency_ghz;
  const double theta = 300.0 / (temperature_c + kKelvinAtZeroCelsius);
  const double eps0 = 77.66 + 103.3 * (theta - 1.0);
  const double eps1 = 0.0671 * eps0;
  const double eps2 = 3.52;
  const double fp = 20.20 - 146.0 * (theta - 1.0) + 316.0 * (theta - 1.0) * (theta - 1.0);
  const double fs = 39.8 * fp;
  const double principal = (eps0 - eps1) / (1.0 + (f / fp) * (f / fp));
  const double secondary = (eps1 - eps2) / (1.0 + (f / fs) * (f / fs));
  const double real = principal + secondary + eps2;
  const double imaginary = principal * (f / fp) + secondary * (f / fs);
  const double eta = (2.0 + real) / imaginary;
  return 0.819 * f / (imaginary * (1.0 + eta * eta));
}

RainCoefficients RainCoefficientsOf(double frequency_ghz, Polarization polarization) {
  const double x = std::log10(frequency_ghz);
  if (polarization == Polarization::kHorizontal) {
    return {.k = std::pow(10.0, Regression(kBellsLogKHorizontal, -0.18961, 0.71147, x)),
            .alpha = Regression(kBellsAlphaHorizontal, 0.67849, -1.95537, x)};
  }
  return {.k = std::pow(10.0, Regression(kBellsLogKVertical, -0.16398, 0.63297, x)),
          .alpha = Regression(kBellsAlphaVertical, -0.053739, 0.83433, x)};
}

double RainAttenuation_dbpkm(double rain_mmph, const RainCoefficients& rain) {
  return rain.k * std::pow(rain_mmph, rain.alpha);
}

double MaxRange_m(double clear_range_m, double attenuation_dbpkm) {
  const double q_pm = attenuation_dbpkm / kMetresPerKilometre * std::numbers::ln10 / 20.0;
  if (q_pm == 0.0) return clear_range_m;
  return boost::math::lambert_w0(q_pm * clear_range_m) / q_pm;
}

}  // namespace fogline::radar
