#include "services/lidar/fog_modes.h"

#include <algorithm>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"

namespace fogline::lidar {

FogModes::FogModes(const FogModesSection& section) : section_(section) {
  // The sum of shares such as 0.1, 0.2 and 0.7 may differ from 1 by a rounding error.
  constexpr double kRounding = 1e-9;
  const double sum = section.biased_share + section.near_echo_share + section.missing_share;
  if (sum > 1 + kRounding) {
    throw InputError(fmt::format(
        "/fog/modes: biased_share {}, near_echo_share {} and missing_share {} add up to {}; the "
        "sum must be at most 1",
        NumberText(section.biased_share), NumberText(section.near_echo_share),
        NumberText(section.missing_share), NumberText(sum)));
  }
}

FogMode FogModes::ModeOf(double u, double level, double target_m) const {
  double below = level * section_.missing_share * MissingAt(target_m);
  if (u < below) return FogMode::kMissing;
  below += level * section_.near_echo_share;
  if (u < below) return FogMode::kNearEcho;
  below += level * section_.biased_share;
  return u < below ? FogMode::kBiased : FogMode::kRight;
}

double FogModes::MissingAt(double target_m) const {
  const double from_m = section_.missing_from_m;
  const double beyond_m = std::max(from_m, section_.missing_beyond_m);
  if (target_m <= from_m) return 0;
  if (target_m >= beyond_m) return 1;
  return (target_m - from_m) / (beyond_m - from_m);
}

}  // namespace fogline::lidar
