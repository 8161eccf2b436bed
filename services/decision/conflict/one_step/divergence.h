// Distances between two Gaussian readings N(x1, s1^2) and N(x2, s2^2): the ranges x1 and x2 of
// radar and LiDAR with their standard deviations. d = x1 - x2, and S = s1^2 + s2^2. NIS = d^2/S is
// the normalised square of the difference, which is used in a chi-square test (Bar-Shalom, Li &
// Kirubarajan 2001, section 5.4). The Bhattacharyya distance is D_B = d^2/(4 S) +
// ln(S/(2 s1 s2))/2, at least 0 (Bhattacharyya 1943). If s1 and s2 differ, the second term of D_B
// is above 0 even at d = 0. Different precisions would then look like conflict, so only the first
// term is used. The Hellinger distance is H = sqrt(1 - exp(-D_B)), in [0, 1].
#pragma once

#include "services/decision/conflict/disagreement.h"

namespace fogline::conflict {

/// NIS = d^2/S, at least 0. Without a fault, NIS has the chi-square distribution with one degree of
/// freedom. NIS is then above 3.84 in 5 %, above 6.63 in 1 %, and above 10.83 in 0.1 % of the
/// steps.
inline double NormalisedSquare(const Disagreement& disagreement) {
  const double u = disagreement.standardised();
  return u * u;
}

/// The first term of D_B, which comes from the means: d^2/(4 S) = NIS/4. This term is at least 0,
/// and 0 at d = 0.
double BhattacharyyaOfMeans(const Disagreement& disagreement);

/// The Hellinger distance H, computed with only the first term of D_B: sqrt(1 - exp(-d^2/(4 S))),
/// in [0, 1].
double HellingerOfMeans(const Disagreement& disagreement);

}  // namespace fogline::conflict
