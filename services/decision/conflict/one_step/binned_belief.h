// Sensor readings as bodies of evidence on bins of range, and measures of evidence theory for two
// bodies.
#pragma once

#include <array>
#include <cstdint>

#include "services/decision/conflict/disagreement.h"

namespace fogline::conflict {

/// Sums over two bodies of evidence m1, m2, sufficient for all measures below. Focal sets are the
/// single bins and the whole frame Theta of n bins. Theta has the mass 1 - eta.
struct BinnedPair {
  double common = 0;         // sum over bins of m1 m2
  double square_1 = 0;       // sum over bins of m1^2
  double square_2 = 0;       // sum over bins of m2^2
  double absolute = 0;       // sum of |BetP1 - BetP2| over the bins that m1 or m2 uses
  double reliability_1 = 0;  // eta1
  double reliability_2 = 0;  // eta2
  double elsewhere = 0;      // share of the frame's bins that m1 and m2 do not use
  double bins = 0;           // n
};

/// Radar (1) and LiDAR (2) on bins of `bin_width_m`: m({bin}) = eta P(bin), m(Theta) = 1 - eta
/// (Shafer's discounting), where P is the sensor's Gaussian. The radar's reading is an edge of the
/// grid, so that the pair depends only on the difference. The sign of the difference has no effect.
/// A reading within a bin and a reading on an edge give different evidence, even with equal
/// precision. So a measure is larger at the next multiple of the width. Between two multiples it
/// may fall while the difference grows.
BinnedPair PairOnBins(const Disagreement& disagreement, const ConflictParameters& parameters);

/// Dempster's conflict k = sum of m1(A) m2(B) over disjoint A, B, in [0, 1] (Dempster 1967). k has
/// a known defect: it is above 0 for equal evidence.
double DempsterConflict(const BinnedPair& pair);

/// d_J = sqrt((m1 - m2)' D (m1 - m2)/2), D(A, B) = |A and B|/|A or B|, in [0, 1] (Jousselme,
/// Grenier & Bosse 2001).
double JousselmeDistance(const BinnedPair& pair);

/// difBetP = max over A of |BetP1(A) - BetP2(A)|, which is half the sum over single bins, in [0, 1]
/// (Liu 2006).
double PignisticDistance(const BinnedPair& pair);

/// 1 - m1.m2/(|m1| |m2|), in [0, 1] (Wen 2008).
double CosineConflict(const BinnedPair& pair);

/// 1 - r, r = c12/sqrt(c11 c22), c_ab = sum of m_a(A) m_b(B) |A and B|/|A or B|, in [0, 1] (Jiang
/// 2016): the cosine under Jousselme's D.
double CorrelationConflict(const BinnedPair& pair);

}  // namespace fogline::conflict
