// Parameters of all conflict measures, with range and source.
#pragma once

#include <array>

#include "scenario/sections/control.h"

namespace fogline::conflict {

/// Modes of a LiDAR. In kClean, the LiDAR measures the range of the car. In kFogReturn, it measures
/// the range of the fog or of another object. In kDropout, it almost never has an echo.
enum class LidarMode { kClean, kFogReturn, kDropout };
inline constexpr int kLidarModes = 3;

struct ConflictParameters {
  // ---- Difference ----

  /// Mean of radar - LiDAR if no sensor has a fault, m, any finite value. It is the part of the
  /// offset between the mounting points that calibration has not removed. Every measure except
  /// `doc` subtracts the offset. The paper defines `doc` without an offset.
  double offset_m = 0;
  /// Rule for a step in which a sensor has no value. The rule applies to every measure except the
  /// measures of LiDAR modes. A step without a value repeats the last difference, is skipped, or
  /// counts as a difference of `missing_conflict_m`.
  MissingLidar missing = MissingLidar::kHold;
  /// If `missing` is kConflict, a missing value counts as this difference, m, above 0. The
  /// scenario's section `arbitrator` has the same default.
  double missing_conflict_m = 10;
  /// Standard deviations, m, above 0. They are used if a missing value counts as conflict and the
  /// sensor has not yet stated a standard deviation. Sources: Continental ARS408 far range;
  /// Velodyne VLP-16.
  double nominal_radar_std_m = 0.4;
  double nominal_lidar_std_m = 0.03;
  /// Lower limit of stated standard deviations, m, above 0. The limit keeps every quotient finite.
  /// A millimetre is finer than any automotive ranging sensor.
  double smallest_std_m = 1e-3;

  // ---- DoC (Sourav & Cheng 2024) ----

  double doc_slope_pm = 10;                                        // 1/m, above 0; from the paper
  double doc_centre_m = 1;                                         // m; from the paper
  ConflictReading doc_reading = ConflictReading::kMeanOfAbsolute;  // the paper does not state it

  // ---- Windows ----

  /// Number of steps in the windows of DoC and windowed NIS (nis.h), at least 1. The default is the
  /// window of paper.json.
  int window_steps = 8;
  /// Number of steps that the GLR test looks back for a jump, at least 1; 20 steps are 2 s at 10
  /// Hz. Basseville & Nikiforov 1993, 2.4.3, also limit this number, because of the computing cost.
  int glr_window_steps = 20;
  /// Number of steps whose residuals give the NIS blame (third_witness.h), at least 1. If this
  /// number is 1, the blame depends only on the NIS of the present step.
  int blame_window_steps = 1;

  // ---- Beliefs on bins ----

  /// Width of a bin, m, above 0. The default is a little above the larger nominal standard
  /// deviation of the two sensors.
  double bin_width_m = 0.5;
  /// Number of bins of the frame (all ranges that are possible), at least 2. The default of 500
  /// bins of 0.5 m covers 250 m.
  int frame_bins = 500;
  /// Reliability eta of each sensor, in (0, 1): the share of its belief that stays on the bins. The
  /// whole frame gets the rest (Shafer 1976, discounting).
  double radar_reliability = 0.95;
  double lidar_reliability = 0.95;

  // ---- Consonant beliefs ----

  /// A consonant belief is a density over nested intervals (consonant_belief.h). `levels` is the
  /// number of intervals of equal mass that replace the density, at least 1, at most kMostLevels.
  /// With 20 levels, a score differs by at most 0.03 from the score with 40 levels.
  int levels = 20;

  // ---- Sequential tests ----

  /// CUSUM reference value kappa in standard deviations of the difference, at least 0. kappa is
  /// half of the shift that the test detects best (Page 1954).
  double cusum_kappa = 0.5;
  /// Upper limit of the CUSUM in standard deviations, above any threshold in use. Without this
  /// limit, the sum would grow during a long fog bank, and fall below the threshold only long after
  /// the fog bank.
  double cusum_ceiling = 50;
  /// SPRT: shift delta that the test distinguishes from no shift, m, above 0. The default is half
  /// the centre of the DoC.
  double sprt_delta_m = 0.5;
  /// SPRT: probabilities of a false alarm and of a miss, each in (0, 0.5) (Wald 1947).
  double sprt_alpha = 0.01;
  double sprt_beta = 0.01;
  /// Multiple of ln((1 - beta)/alpha) at which the log likelihood ratio stops growing, at least 1.
  /// Without this limit, the ratio would stay high for a long time after a long fog bank, like the
  /// sum of the CUSUM.
  double sprt_ceiling = 4;

  // ---- LiDAR modes (IMM, Blom & Bar-Shalom 1988) ----

  /// Probability of mode j in the next step given mode i in this step (row i, column j), in the
  /// order of LidarMode. The rows add up to 1; each entry is above 0. Our choice: at 10 Hz, mode
  /// clean lasts 10 s on average, and the other modes last 1 s.
  std::array<std::array<double, kLidarModes>, kLidarModes> mode_transition{
      {{0.99, 0.005, 0.005}, {0.05, 0.9, 0.05}, {0.05, 0.05, 0.9}}};
  /// Probability of an echo in each mode, in (0, 1). Our choice.
  std::array<double, kLidarModes> echo_probability{0.98, 0.9, 0.02};
  /// r*, the range at which the echo of the fog is strongest, m, above 0. For a pulse of 5 ns, r*
  /// is 4.0 m at a visibility of 600 m, and 3.1 m at a visibility of 20 m
  /// (services/lidar/fog_beam.h).
  double fog_return_m = 3.5;
  /// Length in m, above 0. A fog echo lies beyond r* by this length times a random number with the
  /// distribution Beta(2, 20) (Hahner et al. 2021).
  double fog_scatter_m = 10;
  /// Share of the echoes in mode kFogReturn that can lie anywhere in the LiDAR's range, in (0, 1).
  /// Such a stray echo may be a mixture of the echoes of car and fog. Our choice.
  double stray_share = 0.1;
  /// Range over which stray echoes are uniformly distributed, m, above 0.
  double stray_range_m = 250;
};

}  // namespace fogline::conflict
