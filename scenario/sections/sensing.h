// Sections of a scenario for the sensors and for the weights of their fusion.
#pragma once

#include <array>

#include "scenario/sections/field.h"

namespace fogline {

/// Parameters of the 77 GHz radar at the host's front.
struct RadarSection {
  FOGLINE_FIELD(double, bias_m, 0.954, {-10, 10, "m"},
                "Mounting offset that calibration has not removed. It is added to every range.",
                "our choice, because the paper's RHE of 100 % at threshold 0.2 and 0 % at 0.5 "
                "implies an offset of 0.86 to 1 m; calibrated in paper.json");
  FOGLINE_FIELD(double, lateral_offset_m, 0.0, {-3, 3, "m"},
                "Lateral distance of the sensor from the target's reflection point.",
                "our choice, because the paper's sensors look along the lane");
  FOGLINE_FIELD(double, range_std_m, 0.02, {0, 10, "m"}, "Standard deviation of range noise.",
                "our choice, because the paper's table implies 1 to 5 cm; data sheet of a "
                "Continental ARS408: 0.1 to 0.4 m");
  FOGLINE_FIELD(double, range_rate_std_mps, 0.05, {0, 10, "m/s"},
                "Standard deviation of range rate noise.",
                "our choice, because 0.05 to 0.1 m/s is usual; Continental ARS408: accurate to 0.1 "
                "km/h (0.03 m/s)");
  FOGLINE_FIELD(double, max_range_m, 250.0, {1, 1000, "m"},
                "Maximum range in clear dry air; attenuation shortens it.",
                "Continental ARS408 far scan: 250 m");
  FOGLINE_FIELD(double, dropout_probability, 0.0, {0, 1},
                "Probability that a step has no detection.",
                "our choice, because the paper has no dropouts");
  FOGLINE_FIELD(double, frequency_ghz, 77.0, {1, 1000, "GHz"},
                "Carrier frequency, for ITU-R P.840 and P.838.", "automotive band 76 to 81 GHz");
  FOGLINE_FIELD(double, temperature_c, 10.0, {-8, 40, "C"},
                "Temperature of the fog's droplets, for ITU-R P.840.",
                "our choice, because 10 C is in the middle: at 0, 10 and 20 C ITU-R P.840 has "
                "3.54, 3.15 and 2.71 dB/km per g/m3 at 77 GHz");

  bool operator==(const RadarSection&) const = default;
};

/// Properties of a LiDAR beam, for fog model `beam` and the near echoes of fog model `modes`
/// (Rasshofer et al. 2011; Hahner et al. 2021).
struct LidarBeamSection {
  FOGLINE_FIELD(
      std::int64_t, beams, 15, {1, 101},
      "Number of beams. The range is the median of their echoes, if at least half have one.",
      "our choice, because an odd number has a middle one, and 15 cost about 1 us a step");
  FOGLINE_FIELD(double, pulse_half_width_ns, 5.0, {0.5, 80, "ns"}, "Half-power pulse width tau_H.",
                "Velodyne HDL-64E: 5 ns; Hahner et al. 2021: 20 ns");
  FOGLINE_FIELD(double, overlap_start_m, 2.0, {0.1, 20, "m"},
                "R1: range at which transmitter and receiver begin to overlap.",
                "our choice, because with overlap_end_m of 5 m the fog's echo lies at 3 to 4 m, "
                "where spurious near echoes are seen (1.5 to 5 m); Hahner et al. 2021: 0.9 m");
  FOGLINE_FIELD(double, overlap_end_m, 5.0, {0.2, 40, "m"},
                "R2: range of full overlap; below R1 it counts as R1.",
                "our choice, because it belongs to the value that overlap_start_m explains; Hahner "
                "et al. 2021: 1.0 m");
  FOGLINE_FIELD(
      double, target_reflectivity, 0.5, {1e-3, 100},
      "Gamma of the preceding car's rear: 0.07 for black, usually 0.2, over 4 for reflectors.",
      "our choice, because a rear is paint (0.2) with some reflectors (over 4)");
  FOGLINE_FIELD(double, clear_range_m, 120.0, {1, 1000, "m"},
                "Range at which clear_reflectivity is detected in clear air with probability 1/2.",
                "Ouster OS1: 120 m, but for a reflectivity of 0.8");
  FOGLINE_FIELD(double, clear_reflectivity, 0.1, {1e-3, 100},
                "Gamma_c to which clear_range_m refers.",
                "our choice, because data sheets state the range of such a dark target; this is "
                "optimistic: the Ouster OS1 has its 120 m at 0.8, and 40 m at 0.1");
  FOGLINE_FIELD(double, backscatter_factor, 0.046, {0.001, 1, "1/sr"},
                "Backscatter coefficient beta times visibility.",
                "Hahner et al. 2021: 0.046, range 0.023 to 0.092");
  FOGLINE_FIELD(double, log_std, 0.7, {0.01, 3},
                "Standard deviation of the echo's log power (speckle, patches).",
                "our choice, because 0.5 to 1 is plausible for speckle and patchy fog; no "
                "measurement is known");
  FOGLINE_FIELD(
      double, fog_range_scale_m, 10.0, {0, 100, "m"},
      "Fog echoes lie beyond their peak by this length times a random number of Beta(2, 20).",
      "Hahner et al. 2021, noise variant 4: 10 m");

  bool operator==(const LidarBeamSection&) const = default;
};

/// Parameters of the host's LiDAR.
struct LidarSection {
  FOGLINE_FIELD(double, bias_m, 0.0, {-10, 10, "m"},
                "Mounting offset that calibration has not removed. It is added to every range.",
                "our choice, because the arbitrator sees only the difference of the sensors, and "
                "radar.bias_m has all of it");
  FOGLINE_FIELD(double, lateral_offset_m, 0.0, {-3, 3, "m"},
                "Lateral distance of the sensor from the target's reflection point.",
                "our choice, because the paper's sensors look along the lane");
  FOGLINE_FIELD(double, range_std_m, 0.01, {0, 10, "m"}, "Standard deviation of range noise.",
                "Ouster OS1: 0.7 to 5 cm by range");
  FOGLINE_FIELD(double, max_range_m, 120.0, {1, 1000, "m"},
                "Echoes from beyond this range are ignored.", "Ouster OS1: 120 m");
  FOGLINE_FIELD(double, dropout_probability, 0.0, {0, 1}, "Probability that a step has no echo.",
                "our choice, because the paper has no dropouts");
  FOGLINE_FIELD(LidarBeamSection, beam, {},
                "Parameters of fog model beam, and of the near echoes of fog model modes.");

  bool operator==(const LidarSection&) const = default;
};

enum class NoiseAdaptation { kNone, kInnovation, kResidual };
constexpr auto ChoicesOf(NoiseAdaptation) {
  return std::to_array<Choice>(
      {{"none", "the paper's: the assumed noise throughout"},
       {"innovation", "by the squared innovation, less the variance of the prediction"},
       {"residual", "by the squared residual, plus the variance of the estimate"}});
}

/// Parameters of the extended Kalman filter that fuses radar and LiDAR (services/fusion).
struct FusionSection {
  FOGLINE_FIELD(
      double, jerk_density_m2ps5, 1.0, {1e-6, 1e3, "m2/s5"},
      "Power spectral density q of the preceding car's jerk (white-noise jerk).",
      "Bar-Shalom et al. 2001, 6.2.3: sqrt(q T) is about the change of the acceleration in a step");
  FOGLINE_FIELD(
      double, radar_range_std_m, 0.05, {1e-4, 10, "m"},
      "Radar range noise that the filter assumes.",
      "our choice, because both sensors should count equally; the same as lidar_range_std_m");
  FOGLINE_FIELD(
      double, radar_range_rate_std_mps, 0.05, {1e-4, 10, "m/s"},
      "Radar range rate noise that the filter assumes.",
      "our choice, because it is the radar's own noise by default, radar.range_rate_std_mps");
  FOGLINE_FIELD(double, lidar_range_std_m, 0.05, {1e-4, 10, "m"},
                "LiDAR range noise that the filter assumes.",
                "our choice, because LiDARs are accurate to 3 to 5 cm (Velodyne VLP-16: 3 cm)");
  FOGLINE_FIELD(NoiseAdaptation, adaptive_noise, NoiseAdaptation::kNone,
                "Whether the filter estimates the noise of each value while it runs. The estimate "
                "is never below the noise that the filter assumes.");
  FOGLINE_FIELD(double, noise_forgetting, 0.3, {0, 1},
                "For adaptive_noise: weight of the estimate so far; the last value has the rest.",
                "Akhlaghi, Zhou & Huang 2017: 0.3");
  FOGLINE_FIELD(
      bool, gating, false,
      "Whether measurements outside the gate are refused; off in the paper's experiment.");
  FOGLINE_FIELD(double, gate_probability, 0.999, {0.5, 0.999999},
                "Probability mass inside the gate (chi-square, 1 degree of freedom).",
                "our choice, because it refuses one good value in 1000");
  FOGLINE_FIELD(
      std::int64_t, gate_reopen_after, 5, {0, 1000, "steps"},
      "Number of refusals in a row after which the gate opens, until a measurement is inside it "
      "again. 0: it never opens.",
      "our choice, because a deviation of half a second (5 steps of 0.1 s) is no outlier");
  FOGLINE_FIELD(double, initial_speed_std_mps, 1.0, {1e-3, 100, "m/s"},
                "Initial uncertainty of the relative speed, if the LiDAR starts the filter.",
                "our choice, because cars that follow each other differ by about 1 m/s");
  FOGLINE_FIELD(double, initial_acceleration_std_mps2, 1.0, {1e-3, 100, "m/s2"},
                "Initial uncertainty of the preceding car's acceleration.",
                "our choice, because ordinary driving stays within about 1 m/s2 most of the time");

  bool operator==(const FusionSection&) const = default;
};

}  // namespace fogline
