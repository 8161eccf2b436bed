// Attenuation of a radar's signal by fog and rain: specific attenuation by the ITU-R
// recommendations, and the resulting maximum range. Pure functions.
#pragma once

namespace fogline::radar {

enum class Polarization { kHorizontal, kVertical };

/// Coefficients of the specific attenuation by rain: k R^alpha in dB/km, at the rain rate R in
/// mm/h.
struct RainCoefficients {
  double k;
  double alpha;
};

/// Liquid water in fog, in g/m3: M = 0.5 (50 m / visibility)^1.285. This power law goes through
/// both pairs of values in ITU-R P.840: 0.05 g/m3 at 300 m and 0.5 g/m3 at 50 m. The true value
/// also depends on the drops, so published formulas differ by a factor of two.
double LiquidWater_gpm3(double visibility_m);

/// Specific attenuation by fog per liquid water, K_l in (dB/km) / (g/m3): ITU-R P.840-8, equations
/// 2 to 11. These equations describe Rayleigh absorption by droplets. They take the permittivity of
/// water from the double Debye model, and are valid up to 200 GHz.
double FogCoefficient(double frequency_ghz, double temperature_c);

/// The coefficients for rain: ITU-R P.838-3, equations 2 and 3, valid from 1 to 1000 GHz, for a
/// horizontal path.
RainCoefficients RainCoefficientsOf(double frequency_ghz, Polarization polarization);

/// Specific attenuation in dB/km by rain of this rate: ITU-R P.838-3, equation 1.
double RainAttenuation_dbpkm(double rain_mmph, const RainCoefficients& rain);

/// Maximum range under this one-way attenuation gamma >= 0. Without attenuation, the maximum range
/// is R_c = `clear_range_m`. The radar equation, with the loss to the target and back, is
///     R^-4 10^(-2 gamma R / 10) = R_c^-4,
/// or R e^(q R) = R_c with q = gamma ln(10) / 20. Its solution is R = W(q R_c) / q, where W is
/// Lambert's function.
double MaxRange_m(double clear_range_m, double attenuation_dbpkm);

}  // namespace fogline::radar
