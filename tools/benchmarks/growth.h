// Measures how the cost of a run grows with the number of cars and of steps, and how the cost of a
// sweep grows with the number of its runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/benchmarks/comparison.h"
#include "tools/benchmarks/comparisons.h"
#include "tools/benchmarks/present.h"

namespace fogline::benchmarks {

/// A size, and the cost of the work of this size.
struct GrowthPoint {
  std::int64_t size = 0;
  Spread wall_s;         // of the whole work, in seconds
  double per_piece = 0;  // median of wall_s for each piece of work (Growth::piece), in us
  double memory_mb = 0;  // peak memory, in MB of 10^6 bytes; median
};

/// One quantity that grows, while all other quantities are constant.
struct Growth {
  std::string name;   // "followers"
  std::string what;   // "following cars"
  std::string piece;  // unit of work to which `per_piece` refers: "step"
  std::vector<GrowthPoint> points;
  /// The measured time for the largest size, divided by the time that a straight line through the
  /// smaller sizes (a least-squares fit) gives for this size. 1: the growth is linear.
  double beyond_linear = 0;
};

/// Measures all sizes once in each round. So a disturbance of the machine affects all sizes.
/// @throws std::runtime_error if a program fails
std::vector<Growth> MeasureGrowth(Effort effort, int rounds);

std::string GrowthText(const std::vector<Growth>& all, const Occasion& occasion);
std::string GrowthMarkdown(const std::vector<Growth>& all, const Occasion& occasion);
std::string GrowthJson(const std::vector<Growth>& all, const Occasion& occasion);

/// Draws the time for one piece of work (Growth::piece) against the size, with one plot for each
/// quantity, as an SVG file.
/// @throws std::runtime_error if gnuplot fails
void DrawGrowth(const std::vector<Growth>& all, const std::filesystem::path& chart);

}  // namespace fogline::benchmarks
