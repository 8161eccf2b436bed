// What the page of the seat is told about a run: only what it shows to the person who drives. A
// participant of an experiment can read everything that comes to their browser, so it must not have
// the condition.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/runtime/wire/wire.h"
#include "tools/web/view_messages.h"

namespace fogline::web {

/// The first frame: the three channels of the seat and their types.
std::string SeatHelloText();

/// The run, with those fields of its scenario that the page needs: how keys move the pedals,
/// whether the brake overrides, the length of a car, and the time of the countdown.
/// @pre the scenario is a JSON object
std::string SeatRunText(const RunFacts& run);

/// The message as the seat gets it: TRUTH as it is; of DRIVER_COMMAND and HOST_COMMAND only the
/// header and the fields that the page shows, and 0 in all others.
/// @param channel its place in kChannels
/// @return nullopt if the seat does not get it
std::optional<std::vector<std::uint8_t>> ForSeat(std::size_t channel, runtime::Bytes bytes);

}  // namespace fogline::web
