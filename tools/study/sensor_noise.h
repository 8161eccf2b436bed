// Realistic noise of the radar, which the scenarios of the studies do not have.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/study/comparison.h"

namespace fogline::study {

/// Standard deviation of a real radar's range, m (data sheet of a Continental ARS408: 0.1 to 0.4).
inline constexpr double kRealisticNoise_m = 0.25;
/// Added to the names of cases that have it.
inline constexpr std::string_view kWithRealisticNoise = " with realistic noise";

/// Overrides for a radar with this noise, which the filter knows.
const std::vector<std::string>& RealisticNoise();
/// The case with these overrides as well.
StudyCase WithRealisticNoise(StudyCase one);
/// What realistic noise is, for the method of a study.
std::string RealisticNoiseText();

}  // namespace fogline::study
