// Who drives in which mode of a host command, and who does not.
#pragma once

#include <cstdint>

#include "fogline/arbitration_t.hpp"

namespace fogline {

/// The host stops, or stands after that, in whichever manoeuvre: of a run in real time whose inputs
/// have failed, or of a driver who was asked and did not come.
constexpr bool InMinimalRisk(std::int8_t mode) {
  return mode == arbitration_t::MINIMAL_RISK || mode >= arbitration_t::MRM_COMFORT;
}

/// In these nothing but the end of the run changes that.
constexpr bool IsLocked(std::int8_t mode) {
  return mode == arbitration_t::MINIMAL_RISK || mode == arbitration_t::MRM_DONE;
}

/// Authority from which on somebody is the one who drives: the human where both have half.
inline constexpr double kMainAuthority = 0.5;

/// The human drives with half of the authority or more; a transfer changes that. Engaged is who has
/// any authority.
constexpr bool HumanDrives(double lambda_human) { return lambda_human >= kMainAuthority; }
constexpr bool HumanIsEngaged(double lambda_human) { return lambda_human > 0; }
/// He has been given the wheel. Under a policy that shares it, or on a ramp, with how much of the
/// authority is not the mode's to say, where he must be asked; where he need not, with half or
/// more.
constexpr bool HumanDrives(std::int8_t mode) {
  return mode == arbitration_t::HUMAN || mode == arbitration_t::RECOVERING;
}

}  // namespace fogline
