// A LiDAR beam in fog: the echo of the target, and the echo of the fog in front of the target. Pure
// functions after Rasshofer, Spies & Spies, Adv. Radio Sci. 9 (2011) 49-60, and Hahner et al., ICCV
// 2021 (arXiv 2108.05249). The received power is the pulse folded with the channel:
//
//   sin^2 pulse of half-power width tau; its length in range is L = c tau (c: speed of light)
//   g(r) = xi(r) exp(-2 alpha r) / r^2    overlap xi of transmitter and receiver, extinction alpha
//   target at R:  P_t = K (Gamma / pi) g(R)                                  Gamma: reflectivity
//   fog before R: P_f = K beta J                                     beta: backscatter in 1/(m sr)
//   J = max over R' of  integral over [R' - L, R'] of  sin^2(pi (R' - r) / L) g(r) dr      in 1/m
//
// A delta function in the channel stands for the target. This file multiplies it by 2/c, so K is
// the same in both formulas. Hahner et al. include the factor 2/c in their Gamma (their Gamma of
// 1e-6 is 150 here). The maximum of the fog's echo lies at r* = R' - L / 2.
#pragma once

#include "scenario/sections/sensing.h"

namespace fogline::lidar {

/// Parameters that shape the echo of the fog.
struct BeamOptics {
  double pulse_length_m;   // L = c tau
  double overlap_start_m;  // R1, xi = 0 up to here
  double overlap_end_m;    // R2 >= R1, xi = 1 from here on, linear between R1 and R2
};

BeamOptics OpticsOf(const LidarBeamSection& beam);

/// xi(r) in [0, 1].
double Overlap(const BeamOptics& optics, double range_m);

/// g(r) in 1/m2.
double ChannelGain(const BeamOptics& optics, double extinction_pm, double range_m);

/// Strongest echo of fog, if no target is in the fog.
struct FogPeak {
  double strength_pm;  // J
  double range_m;      // r*
};

/// Computes J and r* by quadrature and maximisation, which takes some microseconds. (For a short
/// pulse, J is L g(r*) / 2, and g is largest at r*.) extinction_pm >= 0.
FogPeak FindFogPeak(const BeamOptics& optics, double extinction_pm);

/// Random number with the distribution Beta(2, 20), from two uniform numbers in (0, 1). Beta(2, 20)
/// is the distribution of the second smallest of 21 uniform numbers. The smallest number is
/// 1 - u^(1/21). In the interval from this number to 1, the second smallest number has the
/// distribution of the smallest of 20 uniform numbers (Devroye 1986, V.3). The method is exact and
/// needs no rejection.
double Beta2And20(double u, double v);

}  // namespace fogline::lidar
