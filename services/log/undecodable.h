// Finds the first message of a step that does not decode, and makes the text about such a message.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "services/graph.h"
#include "services/log/run_log.h"
#include "services/runtime/wire/wire.h"

namespace fogline::log {

/// The text about a message that does not decode.
/// @param message such as "step 42 of TRUTH"
inline std::string DoesNotDecode(std::string_view message) {
  return fmt::format("{} does not decode: was it altered, or recorded with other message types?",
                     message);
}

/// The first channel of the step whose message does not decode; "" if all messages decode.
inline std::string_view FirstUndecodable(const StepMessages& messages) {
  std::string_view first;
  ForEachStepChannel([&]<class M>(std::size_t channel) {
    M message{};
    if (first.empty() && !messages[channel].empty() &&
        !runtime::Decode(messages[channel], message)) {
      first = ChannelOf<M>().name;
    }
  });
  return first;
}

}  // namespace fogline::log
