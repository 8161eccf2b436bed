// Sequential tests of the difference: they add up the evidence of many steps.
#pragma once

#include "services/decision/conflict/over_time/windowed.h"

namespace fogline::conflict {

/// Cumulative sum g of the standardised difference u = d/sqrt(S) of each step (Page 1954;
/// disagreement.h). The sum detects only a positive shift of d, because fog shortens the LiDAR's
/// range. The value g+ after a step is
///
///     g+ = min(ceiling, max(0, g + u - kappa)),        in [0, ceiling]
///
/// in standard deviations. Example: two tests of opposite sign run together, with kappa = 0.5 and a
/// threshold of 4. Without a fault, they give a false alarm after 168 steps on average. After a
/// shift by one standard deviation, they give the alarm after 8.4 steps on average. With a
/// threshold of 5, these averages are 465 and 10.4 steps. A skipped step does not change g.
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

/// Generalised likelihood ratio for a jump of unknown size and sign at an unknown step j (Willsky &
/// Jones 1976; Basseville & Nikiforov 1993, section 2.4.3):
///
///     max over j of (sum from j to now of u_i)^2/(2 n_j),        at least 0
///
/// over the n_j differences u_i since step j, which lies in the window.
double LargestJump(const Window& standardised);
using Glr =
    Windowed<&Disagreement::standardised, LargestJump, &ConflictParameters::glr_window_steps>;

/// Bounds of the sequential probability ratio test for the error probabilities alpha (false alarm)
/// and beta (miss) (Wald 1947).
struct SprtBounds {
  double accept_agreement;  // ln(beta/(1 - alpha)), below 0
  double accept_conflict;   // ln((1 - beta)/alpha), above 0
};
SprtBounds WaldBounds(double alpha, double beta);

/// Sequential probability ratio test (SPRT) of the hypothesis "the LiDAR's range is too short by
/// delta" against "the range is correct":
///
///     L+ = L + (delta/S)(d - delta/2), clamped to [accept_agreement, ceiling accept_conflict]
///
/// d is the difference of the step and S its variance (disagreement.h); ceiling is sprt_ceiling.
/// The score is L. If L is at least accept_conflict, the test accepts the conflict. If L is
/// accept_agreement, the test accepts agreement. L never falls below accept_agreement, so later
/// evidence of conflict has an effect without delay. If L lies between the bounds, the test makes
/// no decision. So the bounds act as a hysteresis with known error probabilities. A skipped step
/// does not change L.
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

}  // namespace fogline::conflict
