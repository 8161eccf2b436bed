// Represents a sensor reading as a body of evidence of evidence theory (Dempster-Shafer): masses on
// bins of range. Also computes measures of conflict between two bodies of evidence.
#pragma once

#include <array>
#include <cstdint>

#include "services/decision/conflict/disagreement.h"

namespace fogline::conflict {

/// Sums over two bodies of evidence m1 and m2. All measures below can be computed from these sums.
/// m1 and m2 give a mass to each focal set. The focal sets are the single bins, and the whole frame
/// Theta of n bins. The mass of Theta is 1 - eta, where eta is the sensor's reliability. BetP1 and
/// BetP2 are the pignistic probabilities: the mass of Theta is divided equally among the bins.
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
/// (Shafer's discounting), where P is the sensor's Gaussian. The radar's reading is put on an edge
/// of the grid, so the pair depends only on the difference of the readings. The sign of the
/// difference has no effect. A reading within a bin and a reading on an edge give different
/// evidence, even if their standard deviations are equal. So a measure does not always grow with
/// the difference. At each multiple of the bin width, the measure is larger than at the next
/// smaller multiple. But between two multiples, the measure may fall while the difference grows.
BinnedPair PairOnBins(const Disagreement& disagreement, const ConflictParameters& parameters);

/// Dempster's conflict k = sum of m1(A) m2(B) over disjoint A, B, in [0, 1] (Dempster 1967). A
/// known defect of k is that k is above 0 even for equal evidence.
double DempsterConflict(const BinnedPair& pair);

/// Jousselme's distance d_J = sqrt((m1 - m2)' D (m1 - m2)/2), in [0, 1], with
/// D(A, B) = |A and B|/|A or B| for the focal sets A and B (Jousselme, Grenier & Bosse 2001).
double JousselmeDistance(const BinnedPair& pair);

/// difBetP = max over all sets A of bins of |BetP1(A) - BetP2(A)|, in [0, 1] (Liu 2006). This
/// maximum is half the sum of |BetP1 - BetP2| over the single bins.
double PignisticDistance(const BinnedPair& pair);

/// 1 - m1.m2/(|m1| |m2|), in [0, 1]: 1 minus the cosine of the angle between m1 and m2 (Wen 2008).
double CosineConflict(const BinnedPair& pair);

/// 1 - r, with r = c12/sqrt(c11 c22) and c_ab = sum over A, B of m_a(A) m_b(B) D(A, B), in [0, 1]
/// (Jiang 2016). r is the cosine of the angle between m1 and m2 in the metric of Jousselme's D.
double CorrelationConflict(const BinnedPair& pair);

}  // namespace fogline::conflict
