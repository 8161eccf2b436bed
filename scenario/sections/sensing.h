// Sections of a scenario for the sensors and for the weights of their fusion.
#pragma once

#include "scenario/sections/field.h"

namespace fogline {

/// 77 GHz radar at the host's front.
struct RadarSection {
  double bias_m = 0.954;
  double lateral_offset_m = 0.0;
  double range_std_m = 0.02;
  double range_rate_std_mps = 0.05;
  double max_range_m = 250.0;
  double dropout_probability = 0.0;
  double frequency_ghz = 77.0;
  double temperature_c = 10.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("bias_m", self.bias_m,
                 {.min = -10,
                  .max = 10,
                  .unit = "m",
                  .doc = "Mounting offset that was not calibrated out, added to every range.",
                  .source = "our choice, because the paper's RHE of 100 % at threshold 0.2 and 0 % "
                            "at 0.5 implies an offset of 0.86 to 1 m; calibrated in paper.json"});
    visit.Number("lateral_offset_m", self.lateral_offset_m,
                 {.min = -3,
                  .max = 3,
                  .unit = "m",
                  .doc = "Lateral distance of the sensor from the target's reflection point.",
                  .source = "our choice, because the paper's sensors look along the lane"});
    visit.Number("range_std_m", self.range_std_m,
                 {.min = 0,
                  .max = 10,
                  .unit = "m",
                  .doc = "Standard deviation of range noise.",
                  .source = "our choice, because the paper's table implies 1 to 5 cm; data sheet "
                            "of a Continental ARS408: 0.1 to 0.4 m"});
    visit.Number("range_rate_std_mps", self.range_rate_std_mps,
                 {.min = 0,
                  .max = 10,
                  .unit = "m/s",
                  .doc = "Standard deviation of range rate noise.",
                  .source = "our choice, because 0.05 to 0.1 m/s is usual; Continental ARS408: "
                            "accurate to 0.1 km/h (0.03 m/s)"});
    visit.Number("max_range_m", self.max_range_m,
                 {.min = 1,
                  .max = 1000,
                  .unit = "m",
                  .doc = "Maximum range in clear dry air; attenuation shortens it.",
                  .source = "Continental ARS408 far scan: 250 m"});
    visit.Number("dropout_probability", self.dropout_probability,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "Chance that a step has no detection.",
                  .source = "our choice, because the paper knows no dropouts"});
    visit.Number("frequency_ghz", self.frequency_ghz,
                 {.min = 1,
                  .max = 1000,
                  .unit = "GHz",
                  .doc = "Carrier, for ITU-R P.840 and P.838.",
                  .source = "automotive band 76 to 81 GHz"});
    visit.Number("temperature_c", self.temperature_c,
                 {.min = -8,
                  .max = 40,
                  .unit = "C",
                  .doc = "Temperature of the fog's droplets, for ITU-R P.840.",
                  .source = "our choice, because 10 C is in the middle: at 0, 10 and 20 C ITU-R "
                            "P.840 has 3.54, 3.15 and 2.71 dB/km per g/m3 at 77 GHz"});
  }
};

/// Properties of a LiDAR beam, for fog model `beam` (Rasshofer et al. 2011; Hahner et al. 2021).
struct LidarBeamSection {
  std::int64_t beams = 15;
  double pulse_half_width_ns = 5.0;
  double overlap_start_m = 2.0;
  double overlap_end_m = 5.0;
  double target_reflectivity = 0.5;
  double clear_range_m = 120.0;
  double clear_reflectivity = 0.1;
  double backscatter_factor = 0.046;
  double log_std = 0.7;
  double fog_range_scale_m = 10.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Integer(
        "beams", self.beams,
        {.min = 1,
         .max = 101,
         .unit = "",
         .doc = "The range is the median of the beams' echoes, if half have one.",
         .source =
             "our choice, because an odd number has a middle one, and 15 cost about 1 us a step"});
    visit.Number("pulse_half_width_ns", self.pulse_half_width_ns,
                 {.min = 0.5,
                  .max = 80,
                  .unit = "ns",
                  .doc = "Half-power pulse width tau_H.",
                  .source = "Velodyne HDL-64E: 5 ns; Hahner et al. 2021: 20 ns"});
    visit.Number(
        "overlap_start_m", self.overlap_start_m,
        {.min = 0.1,
         .max = 20,
         .unit = "m",
         .doc = "R1: range at which transmitter and receiver begin to overlap.",
         .source = "our choice, because with overlap_end_m of 5 m the fog's echo lies at 3 to 4 m, "
                   "where spurious near echoes are seen (1.5 to 5 m); Hahner et al. 2021: 0.9 m"});
    visit.Number(
        "overlap_end_m", self.overlap_end_m,
        {.min = 0.2,
         .max = 40,
         .unit = "m",
         .doc = "R2: range of full overlap; below R1 it counts as R1.",
         .source = "our choice, because of what overlap_start_m says; Hahner et al. 2021: 1.0 m"});
    visit.Number(
        "target_reflectivity", self.target_reflectivity,
        {.min = 1e-3,
         .max = 100,
         .unit = "",
         .doc = "Gamma of the preceding car's rear: 0.07 black, 0.2 usual, over 4 retro.",
         .source = "our choice, because a rear is paint (0.2) with some reflectors (over 4)"});
    visit.Number(
        "clear_range_m", self.clear_range_m,
        {.min = 1,
         .max = 1000,
         .unit = "m",
         .doc = "Range at which clear_reflectivity is detected in clear air with chance 1/2.",
         .source = "Ouster OS1: 120 m, there for a reflectivity of 0.8"});
    visit.Number(
        "clear_reflectivity", self.clear_reflectivity,
        {.min = 1e-3,
         .max = 100,
         .unit = "",
         .doc = "Gamma_c that clear_range_m is for.",
         .source = "our choice, because data sheets state the range of such a dark target; "
                   "optimistic beside the Ouster OS1, which has its 120 m at 0.8 and 40 m at 0.1"});
    visit.Number("backscatter_factor", self.backscatter_factor,
                 {.min = 0.001,
                  .max = 1,
                  .unit = "1/sr",
                  .doc = "Backscatter coefficient beta times visibility.",
                  .source = "Hahner et al. 2021: 0.046, range 0.023 to 0.092"});
    visit.Number("log_std", self.log_std,
                 {.min = 0.01,
                  .max = 3,
                  .unit = "",
                  .doc = "Standard deviation of the echo's log power (speckle, patches).",
                  .source = "our choice, because 0.5 to 1 is plausible for speckle and patchy fog; "
                            "nothing measured is at hand"});
    visit.Number("fog_range_scale_m", self.fog_range_scale_m,
                 {.min = 0,
                  .max = 100,
                  .unit = "m",
                  .doc = "Fog echoes scatter beyond their peak by this times Beta(2, 20).",
                  .source = "Hahner et al. 2021, noise variant 4: 10 m"});
  }
};

/// LiDAR.
struct LidarSection {
  double bias_m = 0.0;
  double lateral_offset_m = 0.0;
  double range_std_m = 0.01;
  double max_range_m = 120.0;
  double dropout_probability = 0.0;
  LidarBeamSection beam;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("bias_m", self.bias_m,
                 {.min = -10,
                  .max = 10,
                  .unit = "m",
                  .doc = "Mounting offset that was not calibrated out, added to every range.",
                  .source = "our choice, because the arbitrator sees the difference of the sensors "
                            "alone, and radar.bias_m has all of it"});
    visit.Number("lateral_offset_m", self.lateral_offset_m,
                 {.min = -3,
                  .max = 3,
                  .unit = "m",
                  .doc = "Lateral distance of the sensor from the target's reflection point.",
                  .source = "our choice, because the paper's sensors look along the lane"});
    visit.Number("range_std_m", self.range_std_m,
                 {.min = 0,
                  .max = 10,
                  .unit = "m",
                  .doc = "Standard deviation of range noise.",
                  .source = "Ouster OS1: 0.7 to 5 cm by range"});
    visit.Number("max_range_m", self.max_range_m,
                 {.min = 1,
                  .max = 1000,
                  .unit = "m",
                  .doc = "No echo is taken from beyond.",
                  .source = "Ouster OS1: 120 m"});
    visit.Number("dropout_probability", self.dropout_probability,
                 {.min = 0,
                  .max = 1,
                  .unit = "",
                  .doc = "Chance that a step has no echo.",
                  .source = "our choice, because the paper knows no dropouts"});
    visit.Section("beam", self.beam, "For fog model beam.");
  }
};

/// Extended Kalman filter.
struct FusionSection {
  double jerk_density_m2ps5 = 1.0;
  double radar_range_std_m = 0.05;
  double radar_range_rate_std_mps = 0.05;
  double lidar_range_std_m = 0.05;
  bool gating = false;
  double gate_probability = 0.999;
  std::int64_t gate_reopen_after = 5;
  double initial_speed_std_mps = 1.0;
  double initial_acceleration_std_mps2 = 1.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor& visit) {
    visit.Number("jerk_density_m2ps5", self.jerk_density_m2ps5,
                 {.min = 1e-6,
                  .max = 1e3,
                  .unit = "m2/s5",
                  .doc = "Power spectral density q of the preceding car's jerk (white-noise jerk).",
                  .source = "Bar-Shalom et al. 2001, 6.2.3: sqrt(q T) about the change per step"});
    visit.Number(
        "radar_range_std_m", self.radar_range_std_m,
        {.min = 1e-4,
         .max = 10,
         .unit = "m",
         .doc = "Radar range noise that the filter assumes.",
         .source = "our choice, because both sensors are to count alike; as lidar_range_std_m"});
    visit.Number("radar_range_rate_std_mps", self.radar_range_rate_std_mps,
                 {.min = 1e-4,
                  .max = 10,
                  .unit = "m/s",
                  .doc = "Radar range rate noise that the filter assumes.",
                  .source = "our choice, because it is the radar's own noise by default, "
                            "radar.range_rate_std_mps"});
    visit.Number(
        "lidar_range_std_m", self.lidar_range_std_m,
        {.min = 1e-4,
         .max = 10,
         .unit = "m",
         .doc = "LiDAR range noise that the filter assumes.",
         .source = "our choice, because LiDARs are accurate to 3 to 5 cm (Velodyne VLP-16: 3 cm)"});
    visit.Flag("gating", self.gating,
               "Refuse measurements outside the gate; off in the paper's experiment.");
    visit.Number("gate_probability", self.gate_probability,
                 {.min = 0.5,
                  .max = 0.999999,
                  .unit = "",
                  .doc = "Probability mass inside the gate (chi-square, 1 degree of freedom).",
                  .source = "our choice, because it refuses one good value in 1000"});
    visit.Integer(
        "gate_reopen_after", self.gate_reopen_after,
        {.min = 1,
         .max = 1000,
         .unit = "steps",
         .doc = "After so many refusals in a row the gate stays open until a measurement is "
                "inside it again.",
         .source =
             "our choice, because what lasts for half a second (5 steps of 0.1 s) is no outlier"});
    visit.Number(
        "initial_speed_std_mps", self.initial_speed_std_mps,
        {.min = 1e-3,
         .max = 100,
         .unit = "m/s",
         .doc = "Initial relative speed uncertainty, where a LiDAR starts the filter.",
         .source = "our choice, because cars that follow each other differ by about 1 m/s"});
    visit.Number(
        "initial_acceleration_std_mps2", self.initial_acceleration_std_mps2,
        {.min = 1e-3,
         .max = 100,
         .unit = "m/s2",
         .doc = "Initial uncertainty of the preceding car's acceleration.",
         .source =
             "our choice, because ordinary driving stays within about 1 m/s2 most of the time"});
  }
};

}  // namespace fogline
