#include "services/decision/conflict/over_time/third_witness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/decision/conflict/over_time/nis.h"

namespace fogline::conflict {
namespace {

// Similarity 1 - d_J/sqrt(c11) of two beliefs, with d_J^2 = c11 - c12. `square` is c11, and
// `product` is c12.
double Similarity(double product, double square) {
  return 1 - std::sqrt(std::max(0.0, square - product) / square);
}

// Credibilities of radar and LiDAR from the similarities of the pairs; equal shares if all
// similarities are 0.
Support Credibility(double radar_lidar, double radar_prediction, double lidar_prediction) {
  const double sum = 2 * (radar_lidar + radar_prediction + lidar_prediction);
  if (sum <= 0) return {1.0 / 3, 1.0 / 3};
  return {(radar_lidar + radar_prediction) / sum, (radar_lidar + lidar_prediction) / sum};
}

double Shortfall(double support, double agreeing) {
  return std::clamp(1 - support / agreeing, 0.0, 1.0);
}

}  // namespace

SensorResidual::SensorResidual(const ConflictParameters& parameters, double nominal_std_m,
                               double missing_error_m)
    : missing_(parameters.missing),
      missing_error_m_(missing_error_m),
      smallest_std_m_(parameters.smallest_std_m),
      nominal_std_m_(nominal_std_m),
      std_m_(nominal_std_m),
      residuals_(parameters.blame_window_steps) {}

std::optional<double> SensorResidual::Residual(const StatedRange& sensor,
                                               const StatedRange& prediction, double offset_m) {
  if (!prediction.valid) return std::nullopt;
  if (sensor.valid) std_m_ = std::max(sensor.std_m, smallest_std_m_);
  const double scale_m = std::hypot(std_m_, prediction.std_m);
  if (sensor.valid) {
    last_ = (sensor.range_m - offset_m - prediction.range_m) / scale_m;
    return last_;
  }
  if (missing_ == MissingLidar::kHold) return last_;
  if (missing_ == MissingLidar::kSkip) return std::nullopt;
  return missing_error_m_ / scale_m;
}

double SensorResidual::Step(const StatedRange& sensor, const StatedRange& prediction,
                            double offset_m) {
  residuals_.Push(Residual(sensor, prediction, offset_m));
  return prediction.valid ? StandardisedMean(residuals_) : 0;
}

void SensorResidual::Reset() {
  std_m_ = nominal_std_m_;
  last_.reset();
  residuals_.Clear();
}

NisBlame::NisBlame(const ConflictParameters& parameters)
    : offset_m_(parameters.offset_m),
      // A difference radar - LiDAR of missing_conflict_m means that the radar's range is too long,
      // or that the LiDAR's range is too short. So the LiDAR's error is negative.
      radar_(parameters, parameters.nominal_radar_std_m, parameters.missing_conflict_m),
      lidar_(parameters, parameters.nominal_lidar_std_m, -parameters.missing_conflict_m) {}

Blame NisBlame::Step(const Evidence& evidence) {
  const double radar = std::abs(radar_.Step(evidence.radar, evidence.prediction, offset_m_));
  const double lidar = std::abs(lidar_.Step(evidence.lidar, evidence.prediction, 0));
  largest_square_ = std::max(radar, lidar) * std::max(radar, lidar);
  return {.radar = std::erf(radar / std::numbers::sqrt2),
          .lidar = std::erf(lidar / std::numbers::sqrt2),
          .radar_excess = radar - lidar};
}

void NisBlame::Reset() {
  radar_.Reset();
  lidar_.Reset();
  largest_square_ = 0;
}

double NisWitness::Step(const Evidence& evidence) {
  blame_.Step(evidence);
  return blame_.largest_square();
}

Support DengSupport(const BeliefProducts& products) {
  const double square = products.square;
  return Credibility(Similarity(products.radar_lidar, square),
                     Similarity(products.radar_prediction, square),
                     Similarity(products.lidar_prediction, square));
}

Support MurphySupport(const BeliefProducts& products) {
  // d_J^2 between belief i and the average of j and k is half of
  //     |m_i - (m_j + m_k)/2|^2 = 3/2 c11 - c_ij - c_ik + c_jk/2.
  const auto support = [square = products.square](double to_one, double to_other, double between) {
    const double distance = (1.5 * square - to_one - to_other + between / 2) / 2;
    return 1 - std::sqrt(std::clamp(distance / square, 0.0, 1.0));
  };
  return {support(products.radar_lidar, products.radar_prediction, products.lidar_prediction),
          support(products.radar_lidar, products.lidar_prediction, products.radar_prediction)};
}

Support MutualSupport(const BeliefProducts& products) {
  // Law of cosines: |a - b|^2 = |a|^2 + |b|^2 - 2 |a| |b| cos. All lengths are sqrt(c11), so
  // cos = c_ab/c11.
  const double square = products.square;
  return Credibility(products.radar_lidar / square, products.radar_prediction / square,
                     products.lidar_prediction / square);
}

BeliefBlame::BeliefBlame(const ConflictParameters& parameters, SupportFunction support)
    : beliefs_(parameters.levels),
      support_(support),
      missing_(parameters.missing),
      offset_m_(parameters.offset_m),
      smallest_std_m_(parameters.smallest_std_m) {}

BeliefProducts BeliefBlame::Products(const std::array<double, 3>& means_m,
                                     const std::array<double, 3>& stds_m) const {
  const auto product = [&](std::size_t i, std::size_t j) {
    return beliefs_.JaccardProduct(std::abs(means_m[i] - means_m[j]), stds_m[i], stds_m[j]);
  };
  return {.square = beliefs_.JaccardSquare(),
          .radar_lidar = product(0, 1),
          .radar_prediction = product(0, 2),
          .lidar_prediction = product(1, 2)};
}

Blame BeliefBlame::Judge(const Evidence& evidence) const {
  const std::array<double, 3> means_m{evidence.radar.range_m - offset_m_, evidence.lidar.range_m,
                                      evidence.prediction.range_m};
  const std::array<double, 3> stds_m{std::max(evidence.radar.std_m, smallest_std_m_),
                                     std::max(evidence.lidar.std_m, smallest_std_m_),
                                     std::max(evidence.prediction.std_m, smallest_std_m_)};
  const Support support = support_(Products(means_m, stds_m));
  const Support agreeing = support_(Products({0, 0, 0}, stds_m));
  return {Shortfall(support.radar, agreeing.radar), Shortfall(support.lidar, agreeing.lidar)};
}

Blame BeliefBlame::Step(const Evidence& evidence) {
  if (!evidence.prediction.valid) return {};
  if (evidence.radar.valid && evidence.lidar.valid) return last_ = Judge(evidence);
  switch (missing_) {
    case MissingLidar::kHold:
      return last_;
    case MissingLidar::kSkip:
      return {};
    case MissingLidar::kConflict:
      return {evidence.radar.valid ? 0.0 : 1.0, evidence.lidar.valid ? 0.0 : 1.0};
  }
  return {};
}

double LargestBlame::Step(const Evidence& evidence) {
  const Blame blame = blame_->Step(evidence);
  return std::max(blame.radar, blame.lidar);
}

}  // namespace fogline::conflict
