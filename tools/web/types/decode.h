// Decodes a message's bytes into JSON, by the description of its type.
#pragma once

#include <cstdint>
#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "tools/web/types/lcm_types.h"

namespace fogline::web {

/// The members of a message as a JSON object, in their order.
///
/// Integers beyond 2^53, such as a run's id, become decimal strings, because JavaScript would round
/// them. Numbers that are infinite or NaN become null. A boolean is true if its byte is not 0.
/// An array becomes a list; an array with several dimensions becomes a list of lists. An array
/// without elements becomes []. In a string that is not valid UTF-8, U+FFFD replaces the wrong
/// bytes, so the result can always be printed.
///
/// @param message with its fingerprint and without a signature (message_signer.h)
/// @return nullopt if the bytes are not exactly one message of this type
std::optional<nlohmann::ordered_json> DecodeJson(const LcmTypes& types, const LcmStruct& type,
                                                 Bytes message);

/// An integer in the form that DecodeJson() writes.
nlohmann::ordered_json IntegerJson(std::int64_t value);

}  // namespace fogline::web
