// The description of message types as JSON, for the pages of fogline-web, and as JSON schemas for
// Foxglove's protocol.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/web/types/lcm_types.h"

namespace fogline::web {

/// The description of each type, by its name: `comment`; `constants`, their values by name;
/// `members`, each with `name`, `type`, `dims`, `comment`, `unit`. A dimension is a number, or the
/// name of the member that has the length. `unit` is "" if the name of the member has no unit.
nlohmann::ordered_json TypesJson(const LcmTypes& types);

/// The fingerprint of each type, by its name, as "0x" and 16 digits.
nlohmann::ordered_json FingerprintsJson(const LcmTypes& types);

/// The channels of services/graph.h in their order: `id` (the index in kChannels), `name`, `type`,
/// `from`, `what`. For STATUS and RESEND, which several roles send, `from` is "everyone".
nlohmann::ordered_json ChannelsJson();

/// The JSON schema for the result of DecodeJson() for a type. Each field has only one type, because
/// Foxglove's and Lichtblick's readers refuse schemas with several types for a field. So the schema
/// does not say that an integer beyond 2^53 is a string, or that an infinite number or NaN is null.
nlohmann::ordered_json SchemaJson(const LcmTypes& types, const LcmStruct& type);

}  // namespace fogline::web
