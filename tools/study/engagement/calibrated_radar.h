// A radar whose mounting offset is known and subtracted.
#pragma once

#include <string>
#include <vector>

#include "scenario/sections/scenario.h"

namespace fogline::study {

/// The ACC's standstill gap, m, with which it keeps the host's gap of step 0 if its distance is
/// right: d_0 = gap - T_hw v, at least 0, rounded to 0.1 mm.
double StandstillWithoutOffset(const Scenario& scenario);

/// Overrides for a radar without the offset of this scenario, a DoC that knows this, and an ACC
/// that keeps the host's gap of step 0.
std::vector<std::string> CalibratedRadar(const Scenario& scenario);

}  // namespace fogline::study
