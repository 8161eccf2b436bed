// Functions that tell which side drives the host. They use the mode and the authorities in
// HOST_COMMAND.
#pragma once

#include <cstdint>

#include "fogline/arbitration_t.hpp"

namespace fogline {

/// Whether the host is in a minimal risk manoeuvre, or stands after such a manoeuvre. The cause is
/// failed inputs in real time, a request that the driver did not answer in time, a severe situation
/// during a request, or a person who left the seat while driving.
constexpr bool InMinimalRisk(std::int8_t mode) {
  return mode == arbitration_t::MINIMAL_RISK ||
         (mode >= arbitration_t::MRM_COMFORT && mode <= arbitration_t::MRM_FAILED);
}

/// Whether the automatic emergency braking is active: it warns or brakes. The mode then does not
/// say which side drives.
constexpr bool InEmergency(std::int8_t mode) {
  return mode == arbitration_t::COLLISION_WARNING || mode == arbitration_t::EMERGENCY_BRAKING;
}

/// Whether the mode lasts until the end of the run.
constexpr bool IsLocked(std::int8_t mode) {
  return mode == arbitration_t::MINIMAL_RISK || mode == arbitration_t::MRM_DONE;
}

/// From this authority on, the human counts as the driver. So if each side has half of the
/// authority, the human counts as the driver.
inline constexpr double kMainAuthority = 0.5;

/// Whether the human drives: the human has at least half of the authority. A transfer is a change
/// of this result. A human with an authority above 0 is engaged.
constexpr bool HumanDrives(double lambda_human) { return lambda_human >= kMainAuthority; }
constexpr bool HumanIsEngaged(double lambda_human) { return lambda_human > 0; }
/// Whether the mode says that the human drives; false if InEmergency(). If the result is true in a
/// run without requests to the driver, the human has half of the authority or more. In a run with
/// requests, the human has a share of the authority, and the mode does not give the size of this
/// share. The share can be less than half if a policy shares the authority between both sides, or
/// while the authority changes gradually.
constexpr bool HumanDrives(std::int8_t mode) {
  return mode == arbitration_t::HUMAN || mode == arbitration_t::RECOVERING;
}

}  // namespace fogline
