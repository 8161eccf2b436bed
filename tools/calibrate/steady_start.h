// Derives gaps from other fields of a scenario, so that a run begins in equilibrium.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "scenario/sections/scenario.h"

namespace fogline::calibrate {

/// Error of the fused distance in clear air, m: the weighted mean of the sensors' offsets. The
/// weight of a sensor is the inverse variance of its range in the filter.
double TrackOffset(const Scenario& scenario);

/// A field whose value is computed from other fields.
struct DerivedField {
  std::string_view pointer;
  double value = 0;
};

/// The fields that StartSteadily() derives.
inline constexpr std::array<std::string_view, 3> kSteadyFields{
    "/world/host_gap_m", "/acc/standstill_m", "/world/follower_gap_m"};

/// Sets the gaps so that automation, human and follower do not accelerate at step 0 in clear air.
/// All cars must have the host's speed v.
///
/// - The host's gap is the equilibrium gap of the driver's IDM (services/models/driver/idm.h),
///   (s_0 + v T) / sqrt(1 - (v/v_0)^delta), with the standstill gap s_0, the time gap T, the
///   desired speed v_0 and the exponent delta.
/// - The ACC's standstill gap d_0 makes the ACC's desired gap, T_hw v + d_0 with the time gap T_hw,
///   equal to the fused distance. The fused distance is the host's gap plus TrackOffset().
/// - The follower's gap is the desired gap of the follower's own ACC.
///
/// Values are rounded to 0.1 mm.
/// @return the fields, in the order of kSteadyFields
/// @throws InputError if the cars differ in speed, if the driver's model is not the IDM or has no
/// equilibrium gap, or if a value is outside its field's range
std::vector<DerivedField> StartSteadily(Scenario& scenario);

}  // namespace fogline::calibrate
