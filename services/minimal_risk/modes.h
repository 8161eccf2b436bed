// Which modes of a host command mean that nobody drives, and which ends that.
#pragma once

#include <cstdint>

#include "fogline/arbitration_t.hpp"

namespace fogline {

/// The host stops, or stands after that, in whichever manoeuvre: of a run in real time whose inputs
/// have failed, or of a driver who was asked and did not come.
constexpr bool InMinimalRisk(std::int8_t mode) {
  return mode == arbitration_t::MINIMAL_RISK || mode >= arbitration_t::MRM_COMFORT;
}

/// A driver who was asked and comes late ends the manoeuvre, until the car stands; nothing else
/// does.
constexpr bool EndsMinimalRisk(std::int8_t mode, std::int8_t before) {
  return mode == arbitration_t::RECOVERING && before != arbitration_t::MINIMAL_RISK &&
         before != arbitration_t::MRM_DONE;
}

}  // namespace fogline
