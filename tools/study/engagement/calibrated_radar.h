// A radar whose mounting offset is known and subtracted.
#pragma once

#include <string>
#include <vector>

#include "scenario/sections/scenario.h"

namespace fogline::study {

/// The standstill gap, m, of an ACC whose measured distance has no offset. With this standstill gap
/// the ACC keeps the gap that the host has in step 0. The value is the gap of step 0 minus the
/// ACC's time gap (headway_s) times the host's speed in step 0. It is at least 0, and is rounded to
/// 0.1 mm.
double StandstillWithoutOffset(const Scenario& scenario);

/// Overrides that remove the radar's offset from this scenario. They also subtract the offset from
/// the centre of the DoC. They set the ACC's standstill gap so that the ACC keeps the host's gap of
/// step 0.
std::vector<std::string> CalibratedRadar(const Scenario& scenario);

}  // namespace fogline::study
