// The kinds of messages that are refused. Each is counted in STATUS by whoever refused it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "fogline/status_t.hpp"

namespace fogline {

struct RefusalKind {
  std::string_view key;  // in JSON and in status_t
  std::int64_t status_t::*counter;
  std::string_view what;  // completes "refused messages: 3 ..."
};

inline constexpr std::array kRefusals{
    RefusalKind{"foreign", &status_t::foreign, "of other runs"},
    RefusalKind{"malformed", &status_t::malformed, "of a wrong size"},
    RefusalKind{"wrong_type", &status_t::wrong_type, "of a wrong type"},
    RefusalKind{"not_finite", &status_t::not_finite, "with numbers that are not finite"},
    RefusalKind{"out_of_window", &status_t::out_of_window, "of impossible steps"},
    RefusalKind{"not_signed", &status_t::not_signed, "without a signature"},
    RefusalKind{"badly_signed", &status_t::badly_signed, "with a wrong signature"},
};

/// How many messages of each kind were refused, in the order of kRefusals.
using Refusals = std::array<std::int64_t, kRefusals.size()>;

}  // namespace fogline
