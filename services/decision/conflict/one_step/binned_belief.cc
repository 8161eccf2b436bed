#include "services/decision/conflict/one_step/binned_belief.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "services/decision/conflict/one_step/normal.h"

namespace fogline::conflict {
namespace {

// Largest number of bins of one belief. The bins cover 6 standard deviations on each side if the
// standard deviation is at most 5 bin widths. With a larger standard deviation, the bins cover
// fewer standard deviations, and the outermost bins contain the remaining probability.
constexpr std::int64_t kMostBins = 64;
constexpr double kReach = 6;  // standard deviations; the probability outside is 2e-9

// Probabilities of the bins first, first + 1, ..., which add up to 1.
struct Bins {
  std::int64_t first;
  std::int64_t count;
  std::array<double, kMostBins> probability;

  double At(std::int64_t bin) const {
    if (bin < first || bin >= first + count) return 0;
    return probability[static_cast<std::size_t>(bin - first)];
  }
};

// The probabilities of a Gaussian on a grid in which bin i is [i width, (i + 1) width).
Bins OnBins(double mean_m, double std_m, double width_m) {
  const auto bin_of = [&](double x_m) {
    return static_cast<std::int64_t>(std::floor(x_m / width_m));
  };
  Bins bins{};
  bins.first = std::max(bin_of(mean_m - kReach * std_m), bin_of(mean_m) - kMostBins / 2);
  const std::int64_t last = std::min(bin_of(mean_m + kReach * std_m), bins.first + kMostBins - 1);
  bins.count = last - bins.first + 1;
  double below = 0;
  for (std::int64_t i = 0; i < bins.count; ++i) {
    const double edge_m = static_cast<double>(bins.first + i + 1) * width_m;
    const double to_edge = i + 1 == bins.count ? 1 : NormalBelow((edge_m - mean_m) / std_m);
    bins.probability[static_cast<std::size_t>(i)] = to_edge - below;
    below = to_edge;
  }
  return bins;
}

// c_ab = sum over A, B of m_a(A) m_b(B) D(A, B), with Jousselme's D. `common` is the sum of m_a m_b
// over the bins, and n the number of bins of the frame.
double JaccardProduct(double common, double eta_a, double eta_b, double n) {
  const double theta_a = 1 - eta_a;
  const double theta_b = 1 - eta_b;
  return common + theta_a * theta_b + (theta_a * eta_b + theta_b * eta_a) / n;
}

double PlainProduct(double common, double eta_a, double eta_b) {
  return common + (1 - eta_a) * (1 - eta_b);
}

// 1 - ab/sqrt(aa bb), clamped to [0, 1] because of rounding.
double OneMinusCosine(double ab, double aa, double bb) {
  return std::clamp(1 - ab / std::sqrt(aa * bb), 0.0, 1.0);
}

}  // namespace

BinnedPair PairOnBins(const Disagreement& disagreement, const ConflictParameters& parameters) {
  // The sign of the difference has no effect, because the grid is the same on both sides of the
  // radar's reading.
  const double distance_m = std::abs(disagreement.difference_m);
  const Bins radar = OnBins(0, disagreement.radar_std_m, parameters.bin_width_m);
  const Bins lidar = OnBins(distance_m, disagreement.lidar_std_m, parameters.bin_width_m);
  const double eta_1 = parameters.radar_reliability;
  const double eta_2 = parameters.lidar_reliability;
  const double n = parameters.frame_bins;
  const double theta_difference = (eta_2 - eta_1) / n;  // Theta's part of BetP1 - BetP2, per bin

  BinnedPair pair{.reliability_1 = eta_1, .reliability_2 = eta_2, .bins = n};
  std::int64_t used = 0;
  const auto add = [&](double p1, double p2) {
    const double m1 = eta_1 * p1;
    const double m2 = eta_2 * p2;
    pair.common += m1 * m2;
    pair.square_1 += m1 * m1;
    pair.square_2 += m2 * m2;
    pair.absolute += std::abs(m1 - m2 + theta_difference);
    ++used;
  };
  for (std::int64_t bin = radar.first; bin < radar.first + radar.count; ++bin) {
    add(radar.At(bin), lidar.At(bin));
  }
  for (std::int64_t bin = lidar.first; bin < lidar.first + lidar.count; ++bin) {
    if (bin < radar.first || bin >= radar.first + radar.count) add(0, lidar.At(bin));
  }
  pair.elsewhere = std::max(0.0, n - static_cast<double>(used)) / n;
  return pair;
}

double DempsterConflict(const BinnedPair& pair) {
  return std::max(0.0, pair.reliability_1 * pair.reliability_2 - pair.common);
}

double JousselmeDistance(const BinnedPair& pair) {
  const double eta_1 = pair.reliability_1;
  const double eta_2 = pair.reliability_2;
  const double square = JaccardProduct(pair.square_1, eta_1, eta_1, pair.bins) +
                        JaccardProduct(pair.square_2, eta_2, eta_2, pair.bins) -
                        2 * JaccardProduct(pair.common, eta_1, eta_2, pair.bins);
  return std::sqrt(std::max(0.0, square) / 2);
}

double PignisticDistance(const BinnedPair& pair) {
  const double outside = pair.elsewhere * std::abs(pair.reliability_2 - pair.reliability_1);
  return std::min(1.0, (pair.absolute + outside) / 2);
}

double CosineConflict(const BinnedPair& pair) {
  const double eta_1 = pair.reliability_1;
  const double eta_2 = pair.reliability_2;
  return OneMinusCosine(PlainProduct(pair.common, eta_1, eta_2),
                        PlainProduct(pair.square_1, eta_1, eta_1),
                        PlainProduct(pair.square_2, eta_2, eta_2));
}

double CorrelationConflict(const BinnedPair& pair) {
  const double eta_1 = pair.reliability_1;
  const double eta_2 = pair.reliability_2;
  return OneMinusCosine(JaccardProduct(pair.common, eta_1, eta_2, pair.bins),
                        JaccardProduct(pair.square_1, eta_1, eta_1, pair.bins),
                        JaccardProduct(pair.square_2, eta_2, eta_2, pair.bins));
}

}  // namespace fogline::conflict
