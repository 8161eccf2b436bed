// Estimates the mode of the LiDAR: it measures the range of the car, it measures the range of the
// fog, or it has no echo.
#pragma once

#include <array>

#include "services/decision/conflict/conflict_measure.h"
#include "services/decision/conflict/conflict_parameters.h"

namespace fogline::conflict {

/// Posterior probabilities mu_j of LiDAR modes that change as a Markov chain, as in the IMM
/// (interacting multiple model, Blom & Bar-Shalom 1988). Here the modes are modes of the LiDAR's
/// measurement, not modes of the car's motion. p_ij is the probability of mode j after mode i, and
/// Lambda_j the likelihood of the step's LiDAR value in mode j:
///
///     c_j = sum_i p_ij mu_i        mu_j = c_j Lambda_j / (sum_k c_k Lambda_k)
///
/// The reference range r is the radar's range, or the predicted range if the radar has no value.
/// The likelihood of an echo at z is Lambda_j = P_echo,j times
///     clean       N(r - z; offset, S)
///     fog return  (1 - e) N(z; r* + E, s_z^2 + V) + e/R
///     dropout     1/R                                       an echo can be anywhere
/// r is the range of the radar. If the radar has no value, r is the filter's prediction, and the
/// offset is 0. N(x; mean, variance) is a Gaussian density. S is the variance of r - z, and s_z the
/// standard deviation that the LiDAR states. E and V are the mean and the variance of fog_scatter_m
/// times a random number with the distribution Beta(2, 20). e is the share of stray echoes, which
/// lie anywhere in the range R (conflict_parameters.h has r* and all other numbers). The likelihood
/// of no echo is 1 - P_echo,j. A missing LiDAR value is evidence of a mode, so
/// ConflictParameters::missing has no effect. If there is an echo but no reference range, only the
/// Markov chain advances.
class LidarModes {
 public:
  using Probabilities = std::array<double, kLidarModes>;  // order of LidarMode; add up to 1

  explicit LidarModes(const ConflictParameters& parameters);

  const Probabilities& Step(const Evidence& evidence);
  void Reset() { probabilities_ = {1, 0, 0}; }

 private:
  /// @param offset_m mean of `reference` - `lidar` if no sensor has a fault
  Probabilities Likelihoods(const StatedRange& reference, double offset_m,
                            const StatedRange& lidar) const;

  ConflictParameters parameters_;
  Probabilities probabilities_{1, 0, 0};
};

/// Measure `lidar_modes`: the probability of a fog return or a dropout, in [0, 1].
class LidarModeConflict final : public ConflictMeasure {
 public:
  explicit LidarModeConflict(const ConflictParameters& parameters) : modes_(parameters) {}

  double Step(const Evidence& evidence) override;
  void Reset() override { modes_.Reset(); }

 private:
  LidarModes modes_;
};

/// The LiDAR's blame is the score of LidarModeConflict. The radar has no modes here and is never
/// blamed.
class LidarModeBlame final : public BlameMeasure {
 public:
  explicit LidarModeBlame(const ConflictParameters& parameters) : conflict_(parameters) {}

  Blame Step(const Evidence& evidence) override { return {0, conflict_.Step(evidence)}; }
  void Reset() override { conflict_.Reset(); }

 private:
  LidarModeConflict conflict_;
};

}  // namespace fogline::conflict
