#include "services/decision/conflict/one_step/consonant_belief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/quadrature/gauss.hpp>

#include "services/decision/conflict/one_step/normal.h"

namespace fogline::conflict {
namespace {

const double kDensityFactor = std::sqrt(2 / std::numbers::pi);

double MaxwellDensity(double y) { return kDensityFactor * y * y * std::exp(-y * y / 2); }

// Length of the intersection of [-a, a] and [d - b, d + b].
double Overlap(double distance, double a, double b) {
  return std::max(0.0, std::min(a, distance + b) - std::max(-a, distance - b));
}

// Probability of the interval [low, high] under N(0, s1^2), minus its probability under N(d, s2^2).
double Excess(double low, double high, double d, double s1, double s2) {
  return NormalBelow(high / s1) - NormalBelow(low / s1) -
         (NormalBelow((high - d) / s2) - NormalBelow((low - d) / s2));
}

// Key of a value of JaccardProduct(). Several measures need the same products in a step. So each
// thread keeps its most recent products (RecentProducts). It keeps enough products for all measures
// of one step.
struct ProductKey {
  int levels = 0;
  double distance_m = 0;
  double std1_m = 0;
  double std2_m = 0;
  friend bool operator==(const ProductKey&, const ProductKey&) = default;
};

class RecentProducts {
 public:
  /// The product of this key; nullptr if the product is not stored.
  const double* Find(const ProductKey& key) const {
    const auto found = std::ranges::find(keys_, key);
    return found == keys_.end() ? nullptr
                                : &values_[static_cast<std::size_t>(found - keys_.begin())];
  }
  double Add(const ProductKey& key, double value) {
    keys_[oldest_] = key;
    values_[oldest_] = value;
    oldest_ = (oldest_ + 1) % kKept;
    return value;
  }

 private:
  static constexpr std::size_t kKept = 8;
  std::array<ProductKey, kKept> keys_{};
  std::array<double, kKept> values_{};
  std::size_t oldest_ = 0;
};

thread_local RecentProducts recent_products;

}  // namespace

double MaxwellBelow(double y) {
  if (y <= 0) return 0;
  return std::erf(y / std::numbers::sqrt2) - kDensityFactor * y * std::exp(-y * y / 2);
}

double ConsonantConflict(const Disagreement& disagreement) {
  // The integral is over the intervals of the narrower belief, because the distribution function F
  // (MaxwellBelow()) of the wider belief varies slowly over these intervals. The integral ends at
  // y = 9, because the integral of the density f (MaxwellDensity()) beyond 9 is below 1e-16.
  constexpr double kReach = 9;
  constexpr int kNodes = 30;
  const double d = std::abs(disagreement.difference_m);
  const auto [narrow, wide] = std::minmax(disagreement.radar_std_m, disagreement.lidar_std_m);
  const auto integrand = [d, s1 = narrow, s2 = wide](double y) {
    return MaxwellDensity(y) * MaxwellBelow((d - s1 * y) / s2);
  };
  const double end = std::min(d / narrow, kReach);
  using Quadrature = boost::math::quadrature::gauss<double, kNodes>;
  return std::clamp(Quadrature::integrate(integrand, 0.0, end), 0.0, 1.0);
}

double ConsonantPignisticDistance(const Disagreement& disagreement) {
  const double d = std::abs(disagreement.difference_m);
  const double s1 = disagreement.radar_std_m;
  const double s2 = disagreement.lidar_std_m;
  // The densities are equal where a x^2 + b x + c = 0. x is the distance from the first mean.
  const double a = 1 / (s1 * s1) - 1 / (s2 * s2);
  const double b = 2 * d / (s2 * s2);
  const double c = -d * d / (s2 * s2) - 2 * std::log(s2 / s1);
  // b >= 0, so q has no cancellation. The roots are q/a and c/q. If s1 = s2, a is 0, and q/a is
  // infinite.
  const double q = -(b + std::sqrt(std::max(0.0, b * b - 4 * a * c))) / 2;
  if (q == 0) return 0;  // equal readings
  const auto [low, high] = std::minmax({q / a, c / q});
  return std::clamp(std::abs(Excess(low, high, d, s1, s2)), 0.0, 1.0);
}

ConsonantBeliefs::ConsonantBeliefs(int levels) : levels_(std::clamp(levels, 1, kMostLevels)) {
  const boost::math::chi_squared squares(3);  // y^2 is a sum of 3 squared normal numbers
  for (int i = 0; i < levels_; ++i) {
    const double share = (i + 0.5) / levels_;
    half_widths_[static_cast<std::size_t>(i)] = std::sqrt(boost::math::quantile(squares, share));
  }
  jaccard_square_ = JaccardProduct(0, 1, 1);
  contour_square_ = ContourProduct(0, 1, 1);
}

double ConsonantBeliefs::JaccardProduct(double distance_m, double std1_m, double std2_m) const {
  const ProductKey key{levels_, distance_m, std1_m, std2_m};
  if (const double* known = recent_products.Find(key)) return *known;
  const auto levels = static_cast<std::size_t>(levels_);
  double sum = 0;
  for (std::size_t i = 0; i < levels; ++i) {
    const double a = std1_m * half_widths_[i];
    for (std::size_t j = 0; j < levels; ++j) {
      const double b = std2_m * half_widths_[j];
      const double common = Overlap(distance_m, a, b);
      sum += common / (2 * (a + b) - common);
    }
  }
  return recent_products.Add(key, sum / (levels_ * levels_));
}

double ConsonantBeliefs::ContourProduct(double distance_m, double std1_m, double std2_m) const {
  const auto levels = static_cast<std::size_t>(levels_);
  double sum = 0;
  for (std::size_t i = 0; i < levels; ++i) {
    for (std::size_t j = 0; j < levels; ++j) {
      sum += Overlap(distance_m, std1_m * half_widths_[i], std2_m * half_widths_[j]);
    }
  }
  return sum / (levels_ * levels_);
}

double ConsonantBeliefs::JousselmeDistance(const Disagreement& disagreement) const {
  const double common = JaccardProduct(std::abs(disagreement.difference_m),
                                       disagreement.radar_std_m, disagreement.lidar_std_m);
  return std::sqrt(std::max(0.0, jaccard_square_ - common));
}

double ConsonantBeliefs::CosineConflict(const Disagreement& disagreement) const {
  const double s1 = disagreement.radar_std_m;
  const double s2 = disagreement.lidar_std_m;
  const double common = ContourProduct(std::abs(disagreement.difference_m), s1, s2);
  return std::clamp(1 - common / (std::sqrt(s1 * s2) * contour_square_), 0.0, 1.0);
}

double ConsonantBeliefs::CorrelationConflict(const Disagreement& disagreement) const {
  const double common = JaccardProduct(std::abs(disagreement.difference_m),
                                       disagreement.radar_std_m, disagreement.lidar_std_m);
  return std::clamp(1 - common / jaccard_square_, 0.0, 1.0);
}

}  // namespace fogline::conflict
