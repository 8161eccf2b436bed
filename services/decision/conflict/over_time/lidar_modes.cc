#include "services/decision/conflict/over_time/lidar_modes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace fogline::conflict {
namespace {

constexpr std::size_t kClean = static_cast<std::size_t>(LidarMode::kClean);
constexpr std::size_t kFogReturn = static_cast<std::size_t>(LidarMode::kFogReturn);
constexpr std::size_t kDropout = static_cast<std::size_t>(LidarMode::kDropout);

// Mean a/(a + b) and variance a b/((a + b)^2 (a + b + 1)) of Beta(a, b).
constexpr double kBetaA = 2;
constexpr double kBetaB = 20;
constexpr double kBetaSum = kBetaA + kBetaB;
constexpr double kScatterMean = kBetaA / kBetaSum;
constexpr double kScatterVariance = kBetaA * kBetaB / (kBetaSum * kBetaSum * (kBetaSum + 1));

double NormalDensity(double x, double variance) {
  return std::exp(-x * x / (2 * variance)) / std::sqrt(2 * std::numbers::pi * variance);
}

}  // namespace

LidarModes::LidarModes(const ConflictParameters& parameters) : parameters_(parameters) {}

LidarModes::Probabilities LidarModes::Likelihoods(const StatedRange& reference, double offset_m,
                                                  const StatedRange& lidar) const {
  Probabilities likelihoods = parameters_.echo_probability;
  if (!lidar.valid) {
    for (double& likelihood : likelihoods) likelihood = 1 - likelihood;
    return likelihoods;
  }
  const double lidar_std_m = std::max(lidar.std_m, parameters_.smallest_std_m);
  const double variance_m2 = lidar_std_m * lidar_std_m;
  const double reference_std_m = std::max(reference.std_m, parameters_.smallest_std_m);
  const double scatter_m = parameters_.fog_scatter_m;
  const double fog_m = parameters_.fog_return_m + kScatterMean * scatter_m;
  const double stray_pm = 1 / parameters_.stray_range_m;

  likelihoods[kClean] *= NormalDensity(reference.range_m - lidar.range_m - offset_m,
                                       variance_m2 + reference_std_m * reference_std_m);
  likelihoods[kFogReturn] *=
      (1 - parameters_.stray_share) *
          NormalDensity(lidar.range_m - fog_m,
                        variance_m2 + kScatterVariance * scatter_m * scatter_m) +
      parameters_.stray_share * stray_pm;
  likelihoods[kDropout] *= stray_pm;
  return likelihoods;
}

const LidarModes::Probabilities& LidarModes::Step(const Evidence& evidence) {
  Probabilities next{};
  for (std::size_t i = 0; i < next.size(); ++i) {
    for (std::size_t j = 0; j < next.size(); ++j) {
      next[j] += parameters_.mode_transition[i][j] * probabilities_[i];
    }
  }
  const bool has_radar = evidence.radar.valid;
  const StatedRange& reference = has_radar ? evidence.radar : evidence.prediction;
  const double offset_m = has_radar ? parameters_.offset_m : 0;  // the offset is that of the radar
  if (reference.valid || !evidence.lidar.valid) {
    const Probabilities likelihoods = Likelihoods(reference, offset_m, evidence.lidar);
    double sum = 0;
    for (std::size_t j = 0; j < next.size(); ++j) {
      next[j] *= likelihoods[j];
      sum += next[j];
    }
    for (double& probability : next) probability /= sum;
  }
  probabilities_ = next;
  return probabilities_;
}

double LidarModeConflict::Step(const Evidence& evidence) {
  const LidarModes::Probabilities& probabilities = modes_.Step(evidence);
  return std::min(1.0, probabilities[kFogReturn] + probabilities[kDropout]);
}

}  // namespace fogline::conflict
