#include "services/lidar/lidar.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "services/visibility.h"

namespace fogline::lidar {
namespace {

constexpr bool HasBias(FogModel model) {
  return model == FogModel::kBias || model == FogModel::kModes;
}

}  // namespace

Lidar::Lidar(const Scenario& scenario)
    : lidar_(scenario.lidar),
      fog_bias_m_(HasBias(scenario.fog.model) ? scenario.fog.bias_m : 0.0),
      random_(scenario.seed, Stream::kLidar),
      noise_(random_, kNoiseDraw, scenario.steps),
      beam_random_(scenario.seed, Stream::kLidarBeam) {
  if (!HasVisibility(scenario.fog.model)) return;
  model_.emplace(lidar_.beam, ExtinctionOf(scenario.fog.clear_visibility_m),
                 ExtinctionOf(scenario.fog.visibility_m));
  if (scenario.fog.model == FogModel::kModes) {
    modes_.emplace(scenario.fog.modes);
  } else {
    echoes_.reserve(static_cast<std::size_t>(lidar_.beam.beams));
  }
}

void Lidar::Restart(const Scenario& scenario) {
  Lidar other(scenario);
  other.noise_.Keep(noise_);
  *this = std::move(other);
}

const lidar_t& Lidar::Step(const truth_t& truth) {
  output_ = {};
  output_.header = truth.header;
  if (DropsOut(truth.header.step)) return output_;
  // If the cars have collided, the gap is negative. The LiDAR then measures a gap of 0.
  const double x = std::max(truth.host_gap_m, 0.0);
  const double target_m = std::sqrt(x * x + lidar_.lateral_offset_m * lidar_.lateral_offset_m);
  const std::optional<Echo> echo = modes_   ? ModalEcho(truth, target_m)
                                   : model_ ? MedianEcho(truth, target_m)
                                            : PlainEcho(truth, target_m);
  if (!echo) return output_;

  const double noise = noise_.At(truth.header.step)[0];
  output_.valid = true;
  output_.range_m = std::max(0.0, echo->range_m + lidar_.bias_m + echo->range_std_m * noise);
  output_.range_std_m = echo->range_std_m;
  output_.intensity = echo->intensity;
  return output_;
}

bool Lidar::DropsOut(std::int64_t step) const {
  return lidar_.dropout_probability > 0.0 &&
         random_.Uniform2(step, kDropoutDraw)[0] < lidar_.dropout_probability;
}

std::optional<Lidar::Echo> Lidar::PlainEcho(const truth_t& truth, double target_m) const {
  return PlainEchoAt(target_m, fog_bias_m_ * truth.fog_level);
}

std::optional<Lidar::Echo> Lidar::PlainEchoAt(double target_m, double bias_m) const {
  if (target_m > lidar_.max_range_m) return std::nullopt;
  return Echo{.range_m = target_m - bias_m, .range_std_m = lidar_.range_std_m, .intensity = 1.0};
}

std::optional<Lidar::Echo> Lidar::ModalEcho(const truth_t& truth, double target_m) const {
  const double u = random_.Uniform2(truth.header.step, kModeDraw)[0];
  switch (modes_->ModeOf(u, truth.fog_level, target_m)) {
    case FogMode::kRight:
      break;
    case FogMode::kBiased:
      return PlainEchoAt(target_m, fog_bias_m_);
    case FogMode::kNearEcho:
      return NearEcho(truth, target_m);
    case FogMode::kMissing:
      return std::nullopt;
  }
  return PlainEchoAt(target_m, 0.0);
}

// The echo has the range that fog model `beam` gives for an echo of the fog. The LiDAR does not see
// fog nearer than overlap_start_m. If the car is nearer than that, it hides the rest of the fog,
// and the echo has the car's range.
Lidar::Echo Lidar::NearEcho(const truth_t& truth, double target_m) const {
  const LidarBeamSection& beam = lidar_.beam;
  if (target_m <= beam.overlap_start_m) {
    return {.range_m = target_m, .range_std_m = lidar_.range_std_m, .intensity = 1.0};
  }
  const EchoPowers expected = model_->At(target_m, truth.fog_visibility_m);
  const auto [u, v] = random_.Uniform2(truth.header.step, kModeScatterDraw);
  const double scattered_m = expected.fog_range_m + beam.fog_range_scale_m * Beta2And20(u, v);
  const double range_m = std::min(scattered_m, target_m);
  return {.range_m = range_m,
          .range_std_m = lidar_.range_std_m,
          .intensity = model_->Intensity(expected.fog, range_m)};
}

std::optional<Lidar::Echo> Lidar::MedianEcho(const truth_t& truth, double target_m) {
  CollectEchoes(truth, target_m);
  if (2 * static_cast<std::int64_t>(echoes_.size()) < lidar_.beam.beams) return std::nullopt;
  // If the number of echoes is even, the median is the nearer of the two middle echoes. So the
  // reported range is always the range of one echo.
  const auto median = echoes_.begin() + static_cast<std::ptrdiff_t>((echoes_.size() - 1) / 2);
  std::nth_element(echoes_.begin(), median, echoes_.end());
  // The variance of the time of arrival has a constant part, and a part proportional to 1 / SNR. At
  // the detection threshold (log_power 0) both parts are equal.
  const double jitter = std::sqrt(1.0 + std::exp(-median->log_power));
  return Echo{.range_m = median->range_m,
              .range_std_m = lidar_.range_std_m * jitter,
              .intensity = model_->Intensity(median->log_power, median->range_m)};
}

void Lidar::CollectEchoes(const truth_t& truth, double target_m) {
  EchoPowers expected = model_->At(target_m, truth.fog_visibility_m);
  if (target_m > lidar_.max_range_m) expected.target = -std::numeric_limits<double>::infinity();
  const LidarBeamSection& beam = lidar_.beam;
  const auto beams = static_cast<std::uint32_t>(beam.beams);
  echoes_.clear();
  for (std::uint32_t n = 0; n < beams; ++n) {
    const auto [a, b] = beam_random_.Normal2(truth.header.step, PowerDraw(n));
    const double target = expected.target + beam.log_std * a;
    const double fog = expected.fog + beam.log_std * b;
    if (std::max(target, fog) < 0.0) continue;
    if (target >= fog) {
      echoes_.push_back({target_m, target});
      continue;
    }
    const auto [u, v] = beam_random_.Uniform2(truth.header.step, ScatterDraw(n));
    const double scattered_m = expected.fog_range_m + beam.fog_range_scale_m * Beta2And20(u, v);
    echoes_.push_back({std::min(scattered_m, target_m), fog});
  }
}

}  // namespace fogline::lidar
