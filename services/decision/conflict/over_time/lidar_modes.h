// Modes of the LiDAR: it measures the range of the car, it measures the range of the fog, or it has
// no echo.
#pragma once

#include <array>

#include "services/decision/conflict/conflict_measure.h"
#include "services/decision/conflict/conflict_parameters.h"

namespace fogline::conflict {

/// Posterior probabilities of LiDAR modes that change as a Markov chain, as in the IMM (Blom &
/// Bar-Shalom 1988). Here the modes are modes of measurement, not of motion:
///
///     c_j = sum_i p_ij mu_i        mu_j = c_j Lambda_j / sum
///
/// The reference range r is the radar's range, or the predicted range if the radar has no value.
/// The likelihood of an echo at z is Lambda_j = P_echo,j times
///     clean       N(r - z; offset, S)
///     fog return  (1 - e) N(z; r* + E, s_z^2 + V) + e/R     E, V: mean, variance of a Beta(2, 20)
///     dropout     1/R                                       an echo can be anywhere
/// with share e of stray echoes over the range R. The likelihood of no echo is 1 - P_echo,j. A
/// missing LiDAR value is evidence of a mode, so the rule for missing values does not apply. If
/// there is an echo but no reference range, only the Markov chain advances.
class LidarModes {
 public:
  using Probabilities = std::array<double, kLidarModes>;  // order of LidarMode; add up to 1

  explicit LidarModes(const ConflictParameters& parameters);

  const Probabilities& Step(const Evidence& evidence);
  void Reset() { probabilities_ = {1, 0, 0}; }

 private:
  Probabilities Likelihoods(const StatedRange& reference, const StatedRange& lidar) const;

  ConflictParameters parameters_;
  Probabilities probabilities_{1, 0, 0};
};

/// P(fog return or dropout), in [0, 1].
class LidarModeConflict final : public ConflictMeasure {
 public:
  explicit LidarModeConflict(const ConflictParameters& parameters) : modes_(parameters) {}

  double Step(const Evidence& evidence) override;
  void Reset() override { modes_.Reset(); }

 private:
  LidarModes modes_;
};

/// Blames the LiDAR with the probability of LidarModeConflict. The radar has no modes here and is
/// never blamed.
class LidarModeBlame final : public BlameMeasure {
 public:
  explicit LidarModeBlame(const ConflictParameters& parameters) : conflict_(parameters) {}

  Blame Step(const Evidence& evidence) override { return {0, conflict_.Step(evidence)}; }
  void Reset() override { conflict_.Reset(); }

 private:
  LidarModeConflict conflict_;
};

}  // namespace fogline::conflict
