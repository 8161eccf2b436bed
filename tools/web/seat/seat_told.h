// The frames about a run for the page /drive: only data that the page shows to the person who
// drives. A participant of an experiment can read everything that the browser receives. So the
// frames contain only those facts about the condition of the trial that the person sees anyway,
// such as the time of the countdown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/runtime/wire/wire.h"
#include "tools/web/seat/open_request.h"
#include "tools/web/view_messages.h"

namespace fogline::web {

/// The first frame: the three channels of the seat and their types.
std::string SeatHelloText();

/// The run, with only those fields of its scenario that the page needs: how keys move the pedals,
/// whether the brake overrides, the length of a car, and the time of the countdown.
/// @pre the scenario is a JSON object
std::string SeatRunText(const RunFacts& run);

/// The beginning of a request to take over, from which the page counts down.
std::string SeatRequestText(const OpenRequest::Request& request);

/// The message in the form that the page gets: the header and the fields that the page shows; all
/// other fields are 0.
/// @param channel index of the channel in kChannels
/// @return nullopt if the page does not get the message, or the message cannot be decoded
std::optional<std::vector<std::uint8_t>> ForSeat(std::size_t channel, runtime::Bytes bytes);

}  // namespace fogline::web
