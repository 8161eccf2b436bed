// Sequential tests of the difference: they add up what single steps can't tell.
#pragma once

#include <optional>

#include "services/conflict/disagreement.h"
#include "services/conflict/window.h"

namespace fogline {

/// One-sided cumulative sum of u = d/sqrt(S), for fog shortens the LiDAR's range (Page 1954):
///
///     g+ = min(ceiling, max(0, g + u - kappa)),        in [0, ceiling]
///
/// in standard deviations. kappa = 0.5 and a threshold of 4 or 5: mean run length 168 or 465 steps
/// to a false alarm of two such tests, one of either sign, and 8.4 or 10.4 to the alarm after a
/// shift by one standard deviation. A skipped step changes nothing.
class Cusum final : public ConflictMeasure {
 public:
  explicit Cusum(const ConflictParameters& parameters);

  double Step(const Evidence& evidence) override;
  void Reset() override;

 private:
  DisagreementSource source_;
  double kappa_;
  double ceiling_;
  double sum_ = 0;
};

/// Generalised likelihood ratio for a jump of unknown size at an unknown step j, either sign
/// (Willsky & Jones 1976; Basseville & Nikiforov 1993, section 2.4.3):
///
///     max over j of (sum from j to now of u_i)^2/(2 n_j),        at least 0
///
/// over the n_j differences since step j, no further back than the window. A skipped step leaves
/// its place empty; an empty window scores 0.
class Glr final : public ConflictMeasure {
 public:
  explicit Glr(const ConflictParameters& parameters);

  double Step(const Evidence& evidence) override;
  void Reset() override;

 private:
  DisagreementSource source_;
  Window standardised_;
};

/// Bounds of the sequential probability ratio test for the error probabilities alpha (false alarm)
/// and beta (miss) (Wald 1947).
struct SprtBounds {
  double accept_agreement;  // ln(beta/(1 - alpha)), below 0
  double accept_conflict;   // ln((1 - beta)/alpha), above 0
};
SprtBounds WaldBounds(double alpha, double beta);

/// SPRT of "the LiDAR is short by delta" against "it is not":
///
///     L+ = L + (delta/S)(d - delta/2),        in [accept_agreement, ceiling accept_conflict]
///
/// L is kept at the lower bound, where agreement is accepted and the test begins again, so its two
/// bounds are a hysteresis with known errors. Scores from accept_conflict on accept the conflict. A
/// skipped step changes nothing.
class Sprt final : public ConflictMeasure {
 public:
  explicit Sprt(const ConflictParameters& parameters);

  double Step(const Evidence& evidence) override;
  void Reset() override;

 private:
  DisagreementSource source_;
  SprtBounds bounds_;
  double delta_m_;
  double ceiling_;
  double log_ratio_ = 0;
};

}  // namespace fogline
