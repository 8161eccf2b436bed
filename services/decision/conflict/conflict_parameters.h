// Parameters of all conflict measures, with range and source.
#pragma once

#include <array>

#include "scenario/sections/control.h"

namespace fogline::conflict {

/// Modes of a LiDAR: it measures the range of the car; of the fog or another object; it has no
/// echo.
enum class LidarMode { kClean, kFogReturn, kDropout };
inline constexpr int kLidarModes = 3;

struct ConflictParameters {
  // ---- Difference ----

  /// Mean of radar - LiDAR without a fault, m, any finite value: offset of the mounting points that
  /// calibration has not removed. Every measure except `doc` subtracts it; the paper defines `doc`
  /// without it.
  double offset_m = 0;
  /// Rule for a step without radar or LiDAR value, for every measure except those of LiDAR modes:
  /// it repeats the last difference, is left out, or counts as a difference of
  /// `missing_conflict_m`.
  MissingLidar missing = MissingLidar::kHold;
  /// m, above 0; as in the arbitrator.
  double missing_conflict_m = 10;
  /// Standard deviations, m, above 0, for a missing value that counts as conflict before the sensor
  /// has stated a standard deviation. Continental ARS408 far range; Velodyne VLP-16.
  double nominal_radar_std_m = 0.4;
  double nominal_lidar_std_m = 0.03;
  /// Lower limit of stated standard deviations, m, above 0; it keeps every quotient finite. A
  /// millimetre is finer than any automotive ranging sensor.
  double smallest_std_m = 1e-3;

  // ---- DoC (Sourav & Cheng 2024) ----

  double doc_slope_pm = 10;                                        // 1/m, above 0; paper
  double doc_centre_m = 1;                                         // m; paper
  ConflictReading doc_reading = ConflictReading::kMeanOfAbsolute;  // the paper does not say

  // ---- Windows ----

  /// Steps of the windows of DoC and windowed NIS, at least 1. The window of paper.json.
  int window_steps = 8;
  /// Number of steps that the GLR test looks back for a jump, at least 1; 20 steps are 2 s at 10
  /// Hz. Basseville & Nikiforov 1993, 2.4.3, also limit it because of the cost.
  int glr_window_steps = 20;
  /// Steps of the signed mean from which the NIS blame is computed, at least 1; 1 is the NIS of the
  /// step.
  int blame_window_steps = 1;

  // ---- Beliefs on bins ----

  /// Width of a bin, m, above 0: about the largest standard deviation.
  double bin_width_m = 0.5;
  /// Bins of the frame, at least 2: 250 m of range.
  int frame_bins = 500;
  /// Reliability eta of either sensor (Shafer 1976, discounting), in (0, 1).
  double radar_reliability = 0.95;
  double lidar_reliability = 0.95;

  // ---- Consonant beliefs ----

  /// Number of nested intervals of equal mass that replace the belief density, at least 1, at most
  /// kMostLevels. With 20 the scores are within 0.03 of those with 40.
  int levels = 20;

  // ---- Sequential tests ----

  /// CUSUM reference value kappa in standard deviations of d, at least 0: half of the shift that
  /// the test detects best (Page 1954).
  double cusum_kappa = 0.5;
  /// Upper limit of the sum in standard deviations, above any threshold in use. Without it, the sum
  /// would need as much time to decrease after a fog bank as it had to increase in it.
  double cusum_ceiling = 50;
  /// SPRT: shift delta that the test distinguishes from none, m, above 0: half the centre of the
  /// DoC.
  double sprt_delta_m = 0.5;
  /// SPRT: probabilities of a false alarm and of a miss, each in (0, 0.5) (Wald 1947).
  double sprt_alpha = 0.01;
  double sprt_beta = 0.01;
  /// Multiple of ln((1 - beta)/alpha) at which the log likelihood ratio stops growing, at least 1.
  /// The reason is that of cusum_ceiling.
  double sprt_ceiling = 4;

  // ---- LiDAR modes (IMM, Blom & Bar-Shalom 1988) ----

  /// Probability of mode j in the next step given mode i in this one, in the order of LidarMode.
  /// The rows add up to 1; each entry is above 0. Our choice: at 10 Hz mode clean lasts 10 s on
  /// average, the other modes 1 s.
  std::array<std::array<double, kLidarModes>, kLidarModes> mode_transition{
      {{0.99, 0.005, 0.005}, {0.05, 0.9, 0.05}, {0.05, 0.05, 0.9}}};
  /// Probability of an echo in each mode, in (0, 1). Our choice.
  std::array<double, kLidarModes> echo_probability{0.98, 0.9, 0.02};
  /// r*, the range at which the echo of the fog is strongest, m, above 0. For a pulse of 5 ns it is
  /// 4.0 m at 600 m of visibility, and 3.1 m at 20 m (services/lidar/fog_beam.h).
  double fog_return_m = 3.5;
  /// Fog echoes scatter beyond r* by this times Beta(2, 20), m, above 0 (Hahner et al. 2021).
  double fog_scatter_m = 10;
  /// Share of fog returns that can be anywhere in the LiDAR's range, in (0, 1): echoes from neither
  /// the car nor r*, such as a mixture of both. Our choice.
  double stray_share = 0.1;
  /// Range over which stray echoes are uniformly distributed, m, above 0.
  double stray_range_m = 250;
};

}  // namespace fogline::conflict
