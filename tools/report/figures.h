// The table of figures. The report's HTML page and the figure files for papers are drawn from this
// table.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/metrics/sample.h"

namespace fogline::report {

/// One quantity over time, taken from the samples of a run; NaN where there is no value.
struct Column {
  std::string_view name;
  double (*value)(std::span<const metrics::Sample> samples, std::size_t index);
};

/// Colours on white paper, as in base.css. If there are more runs than colours, RunStyle()
/// distinguishes the runs. The colours are tested under simulated protanopia and deuteranopia, two
/// kinds of colour blindness (Machado, Oliveira & Fernandes 2009). In CIELAB any two of the first
/// five colours are at least 25 apart, and any two of all eight colours are at least 15 apart. On
/// white each colour has a contrast of 3 or more.
inline constexpr std::array<std::string_view, 8> kPalette{
    "#0059a1", "#bd3a29", "#00997f", "#65184c", "#d38003", "#00a0d9", "#5e6572", "#a6484b"};
inline constexpr std::size_t kPaletteSize = kPalette.size();

/// Classes of page.css for the elements of the run with this index. They set the run's colour and,
/// from the ninth run on, a second colour along the middle of the run's lines (a core). The classes
/// distinguish 24 runs.
std::string RunStyle(std::size_t index);

/// Course of a curve between two samples.
enum class Hold {
  kLinear,
  kSince,  // the value is constant since the previous sample, like an applied acceleration
  kUntil,  // the value is constant until the next sample, like a command
};

enum class Dash { kSolid, kDashed, kDotted, kDashDot, kLong };

/// A curve shows a quantity of the run (main or detail), or a limit for a quantity (always dashed).
enum class Part { kMain, kDetail, kLimit };

struct Curve {
  std::string_view column;
  std::string_view label;
  Hold hold;
  int colour;  // index in the palette, for a figure with one run
  Dash dash;   // for several runs on shared axes, where the colour distinguishes the runs
  Part part;   // a detail is hidden at first if several runs share the axes
};

/// An area that is shaded where one curve is below another curve.
struct Shade {
  std::string_view below;  // column of the lower curve; "" for no area
  std::string_view limit;  // column of the upper curve
  std::string_view meaning;
};

struct Figure {
  std::string_view id;
  std::string_view title;
  std::string_view caption;
  std::string_view quantity;
  std::string_view unit;  // "" if none
  int decimals;           // decimals of a value at the reader's cursor
  double least_span;      // smallest range of an axis, so that noise does not look like an event
  std::span<const Curve> curves;
  Shade shade = {};
  /// Whether each run always has a low panel of its own (a strip), even if runs share the axes of
  /// other figures. Noisy curves are unreadable on top of each other.
  bool strips = false;
};

/// The jerk of the host, m/s3: the change of its acceleration since the previous sample, divided by
/// the time since then. NaN for the first sample.
double HostJerk(std::span<const metrics::Sample> samples, std::size_t index);

namespace internal {

template <double metrics::Sample::*kMember>
double Get(std::span<const metrics::Sample> samples, std::size_t index) {
  return samples[index].*kMember;
}

}  // namespace internal

inline constexpr std::array kColumns{
    Column{"time_s", internal::Get<&metrics::Sample::time_s>},
    Column{"preceding_speed_mps", internal::Get<&metrics::Sample::preceding_speed_mps>},
    Column{"host_speed_mps", internal::Get<&metrics::Sample::host_speed_mps>},
    Column{"follower_speed_mps", internal::Get<&metrics::Sample::follower_speed_mps>},
    Column{"host_gap_m", internal::Get<&metrics::Sample::host_gap_m>},
    Column{"radar_range_m", internal::Get<&metrics::Sample::radar_range_m>},
    Column{"lidar_range_m", internal::Get<&metrics::Sample::lidar_range_m>},
    Column{"fused_distance_m", internal::Get<&metrics::Sample::fused_distance_m>},
    Column{"host_safe_distance_m", internal::Get<&metrics::Sample::host_safe_distance_m>},
    Column{"doc", internal::Get<&metrics::Sample::doc>},
    Column{"threshold", internal::Get<&metrics::Sample::threshold>},
    Column{"lambda_human", internal::Get<&metrics::Sample::lambda_human>},
    Column{"follower_gap_m", internal::Get<&metrics::Sample::follower_gap_m>},
    Column{"follower_safe_distance_m", internal::Get<&metrics::Sample::follower_safe_distance_m>},
    Column{"host_acceleration_mps2", internal::Get<&metrics::Sample::host_acceleration_mps2>},
    Column{"follower_acceleration_mps2",
           internal::Get<&metrics::Sample::follower_acceleration_mps2>},
    Column{"acc_acceleration_mps2", internal::Get<&metrics::Sample::acc_acceleration_mps2>},
    Column{"driver_acceleration_mps2", internal::Get<&metrics::Sample::driver_acceleration_mps2>},
    Column{"host_jerk_mps3", HostJerk},
};

/// All figures in order. A figure's number is its index plus 1.
std::span<const Figure> Figures();

/// The column with this name.
/// @throws std::out_of_range
const Column& ColumnNamed(std::string_view name);

/// All values of a column.
std::vector<double> Values(const Column& column, std::span<const metrics::Sample> samples);

/// A time span from begin_s up to, but not including, end_s.
struct Window {
  double begin_s;
  double end_s;
};

/// Time spans with fog. A step lasts until the next sample.
std::vector<Window> FogWindows(std::span<const metrics::Sample> samples);

/// Time spans in which the human drives: the human has any authority, as in run_metrics.h.
std::vector<Window> HumanWindows(std::span<const metrics::Sample> samples);

}  // namespace fogline::report
