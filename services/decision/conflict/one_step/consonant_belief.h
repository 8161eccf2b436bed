// Represents a sensor reading as a belief of evidence theory (Dempster-Shafer). The focal sets of
// the belief are nested (consonant). Of all beliefs that fit the reading, this belief claims least
// (the least-committed belief). This file also computes measures of conflict between two beliefs.
#pragma once

#include <array>

#include "services/decision/conflict/disagreement.h"

namespace fogline::conflict {

/// The least-committed belief density among all densities whose pignistic probability is the
/// sensor's Gaussian N(mu, s^2). The focal sets are the nested intervals [mu - y s, mu + y s], with
/// the Maxwell density f(y) = sqrt(2/pi) y^2 exp(-y^2/2) (Smets 2005; Ristic & Smets 2004; Caron et
/// al. 2008). This belief needs no frame with bins, and no reliability of the sensor. (A belief in
/// binned_belief.h needs both.)
///
/// mu is the reading, and s its standard deviation. Dempster's conflict k and the pignistic
/// distance are computed from the density itself (functions below). The other measures need sums
/// over pairs of focal sets. For these measures, `levels` intervals of mass 1/levels each replace
/// the density. Their half widths y are the quantiles (i + 1/2)/levels of f. |A| is the length of
/// an interval A.
class ConsonantBeliefs {
 public:
  static constexpr int kMostLevels = 64;

  /// @param levels in [1, kMostLevels]
  explicit ConsonantBeliefs(int levels);

  /// c12, in [0, 1]: the sum of m1(A) m2(B) D(A, B) over all focal sets A of reading 1 and B of
  /// reading 2. D(A, B) = |A and B|/|A or B| is the matrix of Jousselme's distance.
  /// @param distance_m distance between the two readings, at least 0
  /// @param std1_m, std2_m above 0
  double JaccardProduct(double distance_m, double std1_m, double std2_m) const;
  /// c11 = c22: the product of a reading with itself. This product is equal for all readings.
  double JaccardSquare() const { return jaccard_square_; }

  /// Integral over x of pl1(x) pl2(x), in m. pl(x), the contour of a belief, is the plausibility of
  /// the single range x. The contour determines a consonant belief completely.
  double ContourProduct(double distance_m, double std1_m, double std2_m) const;

  /// Jousselme's distance d_J, in [0, 1].
  double JousselmeDistance(const Disagreement& disagreement) const;
  /// 1 - cosine of the contours, in [0, 1]. For two different readings, the cosine of the masses
  /// themselves would always be 0, because an interval of one reading is never equal to an interval
  /// of the other reading.
  double CosineConflict(const Disagreement& disagreement) const;
  /// 1 - r, with r = c12/sqrt(c11 c22), in [0, 1].
  double CorrelationConflict(const Disagreement& disagreement) const;

 private:
  int levels_;
  std::array<double, kMostLevels> half_widths_{};  // y of each interval, in standard deviations
  double jaccard_square_;
  double contour_square_;  // for a reading with s = 1 m; proportional to s
};

/// F(y) = erf(y/sqrt(2)) - sqrt(2/pi) y exp(-y^2/2), the distribution function of the Maxwell
/// density f; 0 for y <= 0.
double MaxwellBelow(double y);

/// Dempster's conflict k(d) = P(s1 Y1 + s2 Y2 < |d|), where Y1 and Y2 are independent and have the
/// density f. It is the probability that an interval of reading 1 and an interval of reading 2 have
/// no point in common,
///     k = integral over [0, |d|/s1] of f(y) F((|d| - s1 y)/s2) dy,
/// in [0, 1], with k(0) = 0. The integral is computed by quadrature, with an error of at most 1e-9.
double ConsonantConflict(const Disagreement& disagreement);

/// Pignistic distance difBetP, in [0, 1]: the largest difference, over all sets of ranges, between
/// the pignistic probabilities of the two readings. These probabilities are the Gaussians
/// themselves, so difBetP is the total variation of the Gaussians. The difference is largest for
/// the interval between the points of equal density. At d = 0, difBetP is above 0 if the standard
/// deviations differ.
double ConsonantPignisticDistance(const Disagreement& disagreement);

}  // namespace fogline::conflict
