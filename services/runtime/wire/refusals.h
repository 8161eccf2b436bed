// The kinds of messages that are refused, and their names. The process that refuses a message
// counts it in its STATUS.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

struct RefusalKind {
  std::string_view key;  // name in JSON and in status_t
  std::int64_t status_t::*counter;
  std::string_view what;  // the words after the count in "refused messages: 3 ..."
};

inline constexpr std::array kRefusals{
    RefusalKind{"foreign", &status_t::foreign, "of other runs"},
    RefusalKind{"malformed", &status_t::malformed, "of a wrong size"},
    RefusalKind{"wrong_type", &status_t::wrong_type, "of a wrong type"},
    RefusalKind{"not_finite", &status_t::not_finite, "with numbers that are not finite"},
    RefusalKind{"out_of_window", &status_t::out_of_window, "of impossible steps"},
    RefusalKind{"not_signed", &status_t::not_signed, "without a signature"},
    RefusalKind{"badly_signed", &status_t::badly_signed, "with a wrong signature"},
    RefusalKind{"out_of_range", &status_t::out_of_range, "with numbers outside of their range"},
    RefusalKind{"too_frequent", &status_t::too_frequent, "sent too often"},
    RefusalKind{"second_seat", &status_t::second_seat, "of a second seat"},
};

/// The counter of a kind of refusal; nullptr means that the message is not refused.
using RefusalCounter = std::int64_t status_t::*;

/// Decodes a message.
/// @return why the message must be refused; nullptr if the message is valid. Run and step are not
///     checked here.
template <class M>
[[nodiscard]] RefusalCounter Examine(Bytes bytes, M& message) {
  if (bytes.size() < kHeaderEnd) return &status_t::malformed;
  if (ReadInt64(bytes, 0) != M::getHash()) return &status_t::wrong_type;
  if (!Decode(bytes, message)) return &status_t::malformed;
  return FirstNonFiniteField(message).empty() ? nullptr : &status_t::not_finite;
}

/// How many messages of each kind were refused, in the order of kRefusals.
using Refusals = std::array<std::int64_t, kRefusals.size()>;

}  // namespace fogline::runtime
