// Holes in the curves of a run whose log lacks messages.
#pragma once

#include <vector>

#include "services/metrics/sample.h"

namespace fogline::metrics {

/// The samples of a run, with a sample without values at the beginning of each gap. So a curve has
/// a hole there, and no line from one side of the gap to the other.
std::vector<Sample> WithHoles(const std::vector<Sample>& samples, double step_s);

}  // namespace fogline::metrics
