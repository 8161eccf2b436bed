// The numbers of all conflict measures, with range and source.
#pragma once

#include <array>

#include "scenario/control.h"

namespace fogline {

/// Modes of a LiDAR: it ranges the car; it ranges the fog (or something else); it has no echo.
enum class LidarMode { kClean, kFogReturn, kDropout };
inline constexpr int kLidarModes = 3;

struct ConflictParameters {
  // ---- What is compared ----

  /// Mean of radar - LiDAR without a fault, m: mounting points that were not calibrated out. Any
  /// finite value. Subtracted by every measure but `doc`, which the paper defines without it.
  double offset_m = 0;
  /// A step without radar or LiDAR value, for every measure but those of LiDAR modes: repeats the
  /// last difference, is left out, or counts as a difference of `missing_conflict_m`.
  MissingLidar missing = MissingLidar::kHold;
  /// m, above 0; as in the arbitrator.
  double missing_conflict_m = 10;
  /// Standard deviations for a missing value that counts as conflict before the sensor has ever
  /// stated one, m, above 0. Continental ARS408 far range; Velodyne VLP-16.
  double nominal_radar_std_m = 0.4;
  double nominal_lidar_std_m = 0.03;
  /// Stated standard deviations below this count as this, m, above 0: a millimetre, finer than any
  /// automotive ranging sensor. Keeps every quotient finite.
  double smallest_std_m = 1e-3;

  // ---- DoC (Sourav & Cheng 2024) ----

  double doc_slope_pm = 10;                                        // 1/m, above 0; paper
  double doc_centre_m = 1;                                         // m; paper
  ConflictReading doc_reading = ConflictReading::kMeanOfAbsolute;  // the paper leaves it open

  // ---- Windows ----

  /// Steps of the windows of DoC and windowed NIS, at least 1. The window of paper.json.
  int window_steps = 8;
  /// Longest jump that the GLR test looks back for, steps, at least 1. Basseville & Nikiforov
  /// 1993, 2.4.3, bound it as here, for the cost; 2 s at 10 Hz.
  int glr_window_steps = 20;
  /// Steps of the signed mean behind the NIS blame, at least 1; 1 is the NIS of the step.
  int blame_window_steps = 1;

  // ---- Beliefs on bins ----

  /// Width, m, above 0: about the largest standard deviation.
  double bin_width_m = 0.5;
  /// Bins of the frame, at least 2: 250 m of range.
  int frame_bins = 500;
  /// Reliability eta of either sensor (Shafer 1976, discounting), in (0, 1).
  double radar_reliability = 0.95;
  double lidar_reliability = 0.95;

  // ---- Consonant beliefs ----

  /// Nested intervals of equal mass that stand for the density of them, at least 1, at most
  /// kMostLevels. With 20 the scores are
  /// within 0.03 of those with 40.
  int levels = 20;

  // ---- Sequential tests ----

  /// CUSUM reference value kappa in standard deviations of d, at least 0: half of the shift to be
  /// found best (Page 1954).
  double cusum_kappa = 0.5;
  /// The sum stays below this, in standard deviations, above any threshold in use: without it the
  /// sum of a long fog bank would take as long to come down again.
  double cusum_ceiling = 50;
  /// SPRT: shift delta to be told from none, m, above 0: half the centre of the DoC.
  double sprt_delta_m = 0.5;
  /// SPRT: probabilities of a false alarm and of a miss, each in (0, 0.5) (Wald 1947).
  double sprt_alpha = 0.01;
  double sprt_beta = 0.01;
  /// Multiple of ln((1 - beta)/alpha) at which the log likelihood ratio stops growing, at least 1;
  /// as cusum_ceiling.
  double sprt_ceiling = 4;

  // ---- LiDAR modes (IMM, Blom & Bar-Shalom 1988) ----

  /// Probability of mode j in the next step given mode i in this one; order of LidarMode, rows add
  /// up to 1, no entry 0. Chosen by us: at 10 Hz a clean LiDAR stays so for 10 s, the others for 1
  /// s.
  std::array<std::array<double, kLidarModes>, kLidarModes> mode_transition{
      {{0.99, 0.005, 0.005}, {0.05, 0.9, 0.05}, {0.05, 0.05, 0.9}}};
  /// Probability of an echo in each mode, in (0, 1). Chosen by us.
  std::array<double, kLidarModes> echo_probability{0.98, 0.9, 0.02};
  /// r*, where the echo of the fog is strongest, m, above 0: 4.0 m to 3.1 m at 600 m to 20 m of
  /// visibility for a pulse of 5 ns (services/lidar/fog_beam.h).
  double fog_return_m = 3.5;
  /// Fog echoes scatter beyond r* by this times Beta(2, 20), m, above 0 (Hahner et al. 2021).
  double fog_scatter_m = 10;
  /// Share of wrong echoes that are anywhere in the LiDAR's range, in (0, 1): what is neither the
  /// car nor r*, like the mixture of both. Chosen by us.
  double stray_share = 0.1;
  /// Range over which stray echoes are spread evenly, m, above 0.
  double stray_range_m = 250;
};

}  // namespace fogline
