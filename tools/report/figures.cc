#include "tools/report/figures.h"

#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace fogline::report {
namespace {

constexpr std::array kSpeeds{
    Curve{"preceding_speed_mps", "preceding car", Hold::kLinear, 2, Dash::kDotted, Part::kMain},
    Curve{"host_speed_mps", "host", Hold::kLinear, 0, Dash::kSolid, Part::kMain},
    Curve{"follower_speed_mps", "following car", Hold::kLinear, 1, Dash::kDashed, Part::kMain},
};

constexpr std::array kHostGap{
    Curve{"radar_range_m", "radar", Hold::kLinear, 2, Dash::kDotted, Part::kDetail},
    Curve{"lidar_range_m", "LiDAR", Hold::kLinear, 4, Dash::kDashDot, Part::kDetail},
    Curve{"fused_distance_m", "fused", Hold::kLinear, 1, Dash::kLong, Part::kDetail},
    Curve{"host_gap_m", "true gap", Hold::kLinear, 0, Dash::kSolid, Part::kMain},
    Curve{"host_safe_distance_m", "safe distance", Hold::kLinear, 3, Dash::kDashed, Part::kLimit},
};

constexpr std::array kConflict{
    Curve{"lambda_human", "human's authority", Hold::kUntil, 4, Dash::kDotted, Part::kDetail},
    Curve{"doc", "Degree of Conflict", Hold::kLinear, 0, Dash::kSolid, Part::kMain},
    Curve{"threshold", "threshold", Hold::kLinear, 3, Dash::kDashed, Part::kLimit},
};

constexpr std::array kFollowerGap{
    Curve{"follower_gap_m", "gap", Hold::kLinear, 0, Dash::kSolid, Part::kMain},
    Curve{"follower_safe_distance_m", "safe distance", Hold::kLinear, 3, Dash::kDashed,
          Part::kLimit},
};

constexpr std::array kAccelerations{
    Curve{"acc_acceleration_mps2", "automation's offer", Hold::kUntil, 2, Dash::kDashDot,
          Part::kDetail},
    Curve{"driver_acceleration_mps2", "human's offer", Hold::kUntil, 4, Dash::kDotted,
          Part::kDetail},
    Curve{"follower_acceleration_mps2", "following car", Hold::kSince, 1, Dash::kDashed,
          Part::kMain},
    Curve{"host_acceleration_mps2", "host", Hold::kSince, 0, Dash::kSolid, Part::kMain},
};

constexpr std::array kJerk{
    Curve{"host_jerk_mps3", "host", Hold::kSince, 0, Dash::kSolid, Part::kMain},
};

constexpr std::array kFigures{
    Figure{"speeds", "Speeds of the three cars",
           "A host that slows down while the preceding car does not is misled by its sensors.",
           "Speed", "m/s", 3, 0.1, kSpeeds},
    Figure{"host-gap", "Gap from the host to the preceding car",
           "The true gap, the ranges of radar and LiDAR, the fused distance, and the safe distance "
           "at which the host’s ACC aims.",
           "Distance", "m", 3, 0.2, kHostGap,
           Shade{"lidar_range_m", "host_gap_m", "LiDAR reads short"}},
    Figure{"conflict", "Degree of Conflict, and who drives",
           "From the threshold on, the arbitrator hands the host over to the human.",
           "Degree of Conflict, authority", "", 3, 1.0, kConflict},
    Figure{"follower-gap", "Gap from the following car to the host",
           "Safety is compromised while the gap is below the following car’s safe distance.",
           "Distance", "m", 3, 0.2, kFollowerGap,
           Shade{"follower_gap_m", "follower_safe_distance_m", "safety compromised"}},
    Figure{"accelerations", "Accelerations",
           "The accelerations of host and following car, and the accelerations that automation and "
           "human request for the host.",
           "Acceleration", "m/s²", 3, 0.1, kAccelerations, Shade{}, true},
    Figure{"jerk", "Jerk of the host",
           "The change of its acceleration from step to step: abrupt transfers of control show as "
           "peaks.",
           "Jerk", "m/s³", 2, 0.2, kJerk, Shade{}, true},
};

template <class Predicate>
std::vector<Window> WindowsWhere(std::span<const metrics::Sample> samples, Predicate holds) {
  std::vector<Window> windows;
  bool open = false;
  for (const metrics::Sample& sample : samples) {
    if (open) windows.back().end_s = sample.time_s;
    if (holds(sample) && !open) windows.push_back({sample.time_s, sample.time_s});
    open = holds(sample);
  }
  return windows;
}

}  // namespace

std::string RunStyle(std::size_t index) {
  constexpr std::size_t kCores = 3;
  return fmt::format("c{} r{}", index % kPaletteSize, index / kPaletteSize % kCores);
}

double HostJerk(std::span<const metrics::Sample> samples, std::size_t index) {
  if (index == 0) return std::numeric_limits<double>::quiet_NaN();
  const metrics::Sample& now = samples[index];
  const metrics::Sample& before = samples[index - 1];
  return (now.host_acceleration_mps2 - before.host_acceleration_mps2) /
         (now.time_s - before.time_s);
}

std::span<const Figure> Figures() { return kFigures; }

const Column& ColumnNamed(std::string_view name) {
  for (const Column& column : kColumns) {
    if (column.name == name) return column;
  }
  throw std::out_of_range("no column " + std::string(name));
}

std::vector<double> Values(const Column& column, std::span<const metrics::Sample> samples) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) values.push_back(column.value(samples, i));
  return values;
}

std::vector<Window> FogWindows(std::span<const metrics::Sample> samples) {
  return WindowsWhere(samples, [](const metrics::Sample& sample) { return sample.fog_present; });
}

std::vector<Window> HumanWindows(std::span<const metrics::Sample> samples) {
  return WindowsWhere(samples,
                      [](const metrics::Sample& sample) { return sample.lambda_human > 0; });
}

}  // namespace fogline::report
