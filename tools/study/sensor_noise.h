// Realistic noise of the radar. The scenarios of the studies have less noise.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/study/comparison.h"

namespace fogline::study {

/// Standard deviation of a real radar's range, m (data sheet of a Continental ARS408: 0.1 to 0.4).
inline constexpr double kRealisticNoise_m = 0.25;
/// Text that is added to the names of cases with realistic noise.
inline constexpr std::string_view kWithRealisticNoise = " with realistic noise";

/// Overrides for a radar with realistic noise, and for a filter that knows this noise.
const std::vector<std::string>& RealisticNoise();
/// The case with the overrides of RealisticNoise() added.
StudyCase WithRealisticNoise(StudyCase one);
/// Text that explains realistic noise, for the method of a study.
std::string RealisticNoiseText();

}  // namespace fogline::study
