#include "services/fusion/fusion.h"

#include <cmath>
#include <optional>

#include <Eigen/LU>

#include "services/decision/policies/conflict_inputs.h"
#include "services/decision/policies/policies.h"
#include "services/fusion/line_of_sight.h"

namespace fogline::fusion {
namespace {

// The filter starts only from a range of more than this many lateral offsets. At a smaller range,
// the distance ahead is too uncertain. At 2 offsets, the distance is 0.87 times the range.
constexpr double kStartRangePerOffset = 2.0;

constexpr double Square(double x) { return x * x; }

// Distance ahead of a target at `range_m`; nullopt if the filter cannot start from this range.
std::optional<double> StartDistance(double range_m, double lateral_offset_m) {
  if (range_m <= kStartRangePerOffset * std::abs(lateral_offset_m)) return std::nullopt;
  return std::sqrt(Square(range_m) - Square(lateral_offset_m));
}

}  // namespace

std::array<Gate, Fusion::kNumValues> Fusion::MakeGates(const FusionSection& section) {
  const Gate gate(section.gate_probability, section.gate_reopen_after);
  return {gate, gate, gate};
}

std::array<AdaptiveNoise, Fusion::kNumValues> Fusion::MakeNoises(const FusionSection& section) {
  const auto noise = [&section](double assumed_std) {
    return AdaptiveNoise(section.adaptive_noise, Square(assumed_std), section.noise_forgetting);
  };
  return {noise(section.radar_range_std_m), noise(section.radar_range_rate_std_mps),
          noise(section.lidar_range_std_m)};
}

Fusion::Fusion(const Scenario& scenario)
    : step_s_(scenario.step_s),
      ekf_(scenario.step_s, scenario.fusion.jerk_density_m2ps5),
      gating_(scenario.fusion.gating),
      gates_(MakeGates(scenario.fusion)),
      adapts_(scenario.fusion.adaptive_noise != NoiseAdaptation::kNone),
      noises_(MakeNoises(scenario.fusion)),
      radar_offset_m_(scenario.radar.lateral_offset_m),
      lidar_offset_m_(scenario.lidar.lateral_offset_m),
      initial_speed_variance_(Square(scenario.fusion.initial_speed_std_mps)),
      initial_acceleration_variance_(Square(scenario.fusion.initial_acceleration_std_mps2)) {
  const policies::PolicyRow& policy = policies::RowOf(scenario.arbitrator.policy);
  if (policy.selects_sensors) policy_ = policy.make(scenario);
  selects_ = gating_ || policy_ != nullptr;
}

bool Fusion::UsesOnDemandInput(const Scenario& scenario) {
  return policies::RowOf(scenario.arbitrator.policy).needs_true_gap;
}

bool Fusion::CopiesShareState(const Scenario& scenario) {
  return policies::RowOf(scenario.arbitrator.policy).selects_sensors;
}

const track_t& Fusion::Step(const ego_t& ego, const radar_t& radar, const lidar_t& lidar) {
  out_.header = ego.header;
  for (const Value value : {kRadarRange, kRadarRangeRate, kLidarRange}) {
    Record(value, 0, 0, track_t::ABSENT);
  }
  if (started_) Predict(ego);
  last_step_ = ego.header.step;
  last_speed_mps_ = ego.speed_mps;
  if (policy_) selection_ = Judge(radar, lidar);
  if (started_) {
    if (radar.valid) CorrectByRadar(radar);
    if (lidar.valid) CorrectByLidar(lidar);
  } else {
    Start(radar, lidar);
  }
  if (started_) Report(ego.acceleration_mps2);
  return out_;
}

// In real time, the steps that lack an input are left out. The host's acceleration in these steps
// is unknown, but its mean follows from the speeds.
void Fusion::Predict(const ego_t& ego) {
  const std::int64_t steps = ego.header.step - last_step_;
  if (steps <= 1) return ekf_.Predict(ego.acceleration_mps2);
  const double mean_mps2 =
      (ego.speed_mps - last_speed_mps_) / (static_cast<double>(steps) * step_s_);
  for (std::int64_t i = 0; i < steps; ++i) ekf_.Predict(mean_mps2);
}

void Fusion::Start(const radar_t& radar, const lidar_t& lidar) {
  if (radar.valid && !selection_.radar) {
    Record(kRadarRange, 0, 0, track_t::DISTRUSTED);
    Record(kRadarRangeRate, 0, 0, track_t::DISTRUSTED);
  }
  if (lidar.valid && !selection_.lidar) Record(kLidarRange, 0, 0, track_t::DISTRUSTED);
  if (radar.valid && selection_.radar && StartFromRadar(radar)) {
    if (lidar.valid) CorrectByLidar(lidar);
  } else if (lidar.valid && selection_.lidar) {
    StartFromLidar(lidar);
  }
}

// Starts with the state that exactly explains the radar's two values. The covariance follows from
// the noise of these values: P = J^-1 R J^-T, with the Jacobian J of both values and the diagonal
// matrix R of their variances. The values contain no information about the acceleration, so the
// variance of the acceleration is a parameter of the scenario.
bool Fusion::StartFromRadar(const radar_t& radar) {
  const std::optional<double> distance = StartDistance(radar.range_m, radar_offset_m_);
  const std::int8_t usage = distance ? track_t::USED : track_t::GATED;
  Record(kRadarRange, 0, noises_[kRadarRange].variance(), usage);
  Record(kRadarRangeRate, 0, noises_[kRadarRangeRate].variance(), usage);
  if (!distance) return false;
  const LineOfSight sight(*distance, radar_offset_m_);
  const double relative_speed = radar.range_rate_mps / sight.cosine();
  Eigen::Matrix2d jacobian;
  jacobian << sight.RangeJacobian(), sight.RangeRateJacobian(relative_speed);
  const Eigen::Matrix2d inverse = jacobian.inverse();
  const Eigen::Vector2d noise(noises_[kRadarRange].variance(), noises_[kRadarRangeRate].variance());
  Ekf::Covariance covariance = Ekf::Covariance::Zero();
  covariance.topLeftCorner<2, 2>() = inverse * noise.asDiagonal() * inverse.transpose();
  covariance(2, 2) = initial_acceleration_variance_;
  ekf_.Start({*distance, relative_speed, 0}, covariance);
  return started_ = true;
}

bool Fusion::StartFromLidar(const lidar_t& lidar) {
  const std::optional<double> distance = StartDistance(lidar.range_m, lidar_offset_m_);
  Record(kLidarRange, 0, noises_[kLidarRange].variance(),
         distance ? track_t::USED : track_t::GATED);
  if (!distance) return false;
  const LineOfSight sight(*distance, lidar_offset_m_);
  const Eigen::Vector3d variances(noises_[kLidarRange].variance() / Square(sight.cosine()),
                                  initial_speed_variance_, initial_acceleration_variance_);
  ekf_.Start({*distance, 0, 0}, variances.asDiagonal());
  return started_ = true;
}

policies::SensorSelection Fusion::Judge(const radar_t& radar, const lidar_t& lidar) {
  conflict::Evidence evidence{
      .radar = policies::StatedBy(radar), .lidar = policies::StatedBy(lidar), .prediction = {}};
  if (started_) {
    const LineOfSight sight(ekf_.state()[0], radar_offset_m_);
    evidence.prediction = {
        .valid = true,
        .range_m = sight.range_m(),
        .std_m = std::sqrt(ekf_.InnovationVariance(sight.RangeJacobian(), /*noise_variance=*/0))};
  }
  return policy_->SelectSensors({.evidence = evidence, .true_gap_m = true_gap_m_});
}

void Fusion::CorrectByRadar(const radar_t& radar) {
  Correct(kRadarRange, radar.range_m);
  Correct(kRadarRangeRate, radar.range_rate_mps);
}

void Fusion::CorrectByLidar(const lidar_t& lidar) { Correct(kLidarRange, lidar.range_m); }

Fusion::Expectation Fusion::Expect(Value value) const {
  const LineOfSight sight(ekf_.state()[0],
                          value == kLidarRange ? lidar_offset_m_ : radar_offset_m_);
  if (value != kRadarRangeRate) return {sight.range_m(), sight.RangeJacobian()};
  const double relative_speed = ekf_.state()[1];
  return {sight.RangeRate(relative_speed), sight.RangeRateJacobian(relative_speed)};
}

void Fusion::Correct(Value value, double measured) {
  const Expectation before = Expect(value);
  const double noise = noises_[value].variance();
  const double innovation = measured - before.value;
  const double variance = ekf_.InnovationVariance(before.jacobian, noise);
  const std::int8_t usage =
      selects_ ? UsageOf(value, Square(innovation) / variance) : track_t::USED;
  Record(value, innovation, variance, usage);
  if (usage != track_t::USED) return;
  const double predicted_variance =
      adapts_ ? ekf_.InnovationVariance(before.jacobian, /*noise_variance=*/0) : 0;
  ekf_.Correct(before.jacobian, innovation, noise);
  if (!adapts_) return;
  const Expectation after = Expect(value);
  noises_[value].Learn(
      {.innovation = innovation,
       .predicted_variance = predicted_variance,
       .residual = measured - after.value,
       .corrected_variance = ekf_.InnovationVariance(after.jacobian, /*noise_variance=*/0)});
}

std::int8_t Fusion::UsageOf(Value value, double normalised_innovation_squared) {
  const bool selected = value == kLidarRange ? selection_.lidar : selection_.radar;
  if (!selected) return track_t::DISTRUSTED;
  if (!gating_ || gates_[value].Admits(normalised_innovation_squared)) return track_t::USED;
  return track_t::GATED;
}

void Fusion::Record(Value value, double innovation, double variance, std::int8_t usage) {
  out_.innovation[value] = innovation;
  out_.innovation_variance[value] = variance;
  out_.usage[value] = usage;
}

// The host's acceleration is known, so its subtraction does not change the covariance.
void Fusion::Report(double host_acceleration_mps2) {
  const Ekf::State& state = ekf_.state();
  out_.valid = 1;
  out_.state[0] = state[0];
  out_.state[1] = state[1];
  out_.state[2] = state[2] - host_acceleration_mps2;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      out_.covariance[row][column] = ekf_.covariance()(row, column);
    }
  }
}

}  // namespace fogline::fusion
