// Holes in the curves of a run whose log lacks messages.
#pragma once

#include <vector>

#include "services/metrics/sample.h"

namespace fogline::metrics {

/// The samples of a run, and in addition a sample without values at the beginning of each gap
/// (steps that the log lacks). So a curve has a hole at the gap, and no line from one side of the
/// gap to the other.
std::vector<Sample> WithHoles(const std::vector<Sample>& samples, double step_s);

}  // namespace fogline::metrics
