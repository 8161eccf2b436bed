// Normalised squares and means of the difference, for chi-square and Gauss tests (Bar-Shalom, Li &
// Kirubarajan 2001, section 5.4).
#pragma once

#include "services/decision/conflict/disagreement.h"
#include "services/decision/conflict/window.h"

namespace fogline::conflict {

/// NIS = d^2/S, at least 0. Without a fault it is chi-square with one degree of freedom: above
/// 3.84, 6.63, 10.83 in 5, 1, 0.1 % of the steps.
inline double NormalisedSquare(const Disagreement& disagreement) {
  const double u = disagreement.standardised();
  return u * u;
}

/// Mean over the window of NIS, at least 0: N times it is chi-square with N degrees of freedom. A
/// skipped step leaves its place empty; an empty window scores 0.
class WindowedNis final : public ConflictMeasure {
 public:
  explicit WindowedNis(const ConflictParameters& parameters);

  double Step(const Evidence& evidence) override;
  void Reset() override;

 private:
  DisagreementSource source_;
  Window squares_;
};

/// T = sum u_i / sqrt(n) with u = d/sqrt(S) over the n differences of the window, any real number.
/// Without a fault T is standard normal; it is mean(d) sqrt(n/S) while S is constant. T is above 0
/// if the LiDAR's range is too short; a range that is too long counts as the opposite of conflict.
/// T is best for a constant bias. A skipped step leaves its place empty; an empty window scores 0.
class SignedNis final : public ConflictMeasure {
 public:
  explicit SignedNis(const ConflictParameters& parameters);

  double Step(const Evidence& evidence) override;
  void Reset() override;

 private:
  DisagreementSource source_;
  Window standardised_;
};

/// sum / sqrt(n) of the n values of a window; 0 if it is empty.
double StandardisedMean(const Window& window);

}  // namespace fogline::conflict
