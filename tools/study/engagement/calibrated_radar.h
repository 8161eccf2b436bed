// A radar whose mounting offset is known and subtracted.
#pragma once

#include <string>
#include <vector>

#include "scenario/sections/scenario.h"

namespace fogline::study {

/// The ACC's standstill gap, m, for an ACC whose measured distance has no offset. With this value
/// the ACC keeps the host's gap of step 0. The value is this gap minus the ACC's time gap
/// (headway_s) times the host's speed in step 0, at least 0, rounded to 0.1 mm.
double StandstillWithoutOffset(const Scenario& scenario);

/// Overrides for a radar without the offset of this scenario. The offset is also subtracted from
/// the centre of the DoC. The ACC keeps the host's gap of step 0.
std::vector<std::string> CalibratedRadar(const Scenario& scenario);

}  // namespace fogline::study
