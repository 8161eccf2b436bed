#include "services/lidar/echo_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "services/visibility.h"

namespace fogline::lidar {

EchoModel::EchoModel(const LidarBeamSection& beam, double from_pm, double to_pm)
    : optics_(OpticsOf(beam)),
      log_target_m2_(std::log(beam.target_reflectivity / beam.clear_reflectivity *
                              beam.clear_range_m * beam.clear_range_m)),
      log_backscatter_(std::log(std::numbers::pi * beam.backscatter_factor /
                                beam.clear_reflectivity * beam.clear_range_m * beam.clear_range_m)),
      from_pm_(std::min(from_pm, to_pm)),
      to_pm_(std::max(from_pm, to_pm)) {
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kNodes - 1);
    const FogPeak peak = FindFogPeak(optics_, from_pm_ + share * (to_pm_ - from_pm_));
    peaks_[i] = {.log_strength = std::log(peak.strength_pm), .range_m = peak.range_m};
  }
}

EchoPowers EchoModel::At(double range_m, double visibility_m) const {
  constexpr double kNoEcho = -std::numeric_limits<double>::infinity();
  if (range_m <= optics_.overlap_start_m) return {kNoEcho, kNoEcho, range_m};
  const double extinction_pm = ExtinctionOf(visibility_m);
  const auto [log_strength, peak_m] = PeakAt(extinction_pm);
  EchoPowers echoes{.target = ClearTarget(range_m) - 2.0 * extinction_pm * range_m,
                    .fog = log_backscatter_ - std::log(visibility_m) + log_strength,
                    .fog_range_m = peak_m};
  if (range_m < peak_m) {
    echoes.fog += std::log(ChannelGain(optics_, extinction_pm, range_m) /
                           ChannelGain(optics_, extinction_pm, peak_m));
    echoes.fog_range_m = range_m;
  }
  return echoes;
}

double EchoModel::Intensity(double log_power, double range_m) const {
  return std::exp(log_power - ClearTarget(range_m));
}

double EchoModel::ClearTarget(double range_m) const {
  return log_target_m2_ + std::log(Overlap(optics_, range_m) / (range_m * range_m));
}

EchoModel::LogPeak EchoModel::PeakAt(double extinction_pm) const {
  const double width_pm = to_pm_ - from_pm_;
  if (width_pm <= 0.0) return peaks_.front();
  const double share = std::clamp((extinction_pm - from_pm_) / width_pm, 0.0, 1.0);
  const double position = share * static_cast<double>(kNodes - 1);
  const auto i = std::min(static_cast<std::size_t>(position), kNodes - 2);
  const double t = position - static_cast<double>(i);
  const LogPeak& a = peaks_[i];
  const LogPeak& b = peaks_[i + 1];
  return {std::lerp(a.log_strength, b.log_strength, t), std::lerp(a.range_m, b.range_m, t)};
}

}  // namespace fogline::lidar
