// The description of message types as JSON: for the page, and as JSON schemas.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tools/web/types/lcm_types.h"

namespace fogline::web {

/// For each type by its name: `comment`; `constants`, their values by name; `members`, each with
/// `name`, `type`, `dims`, `comment`, `unit`. A dimension is a number, or the name of the member
/// that has the length. `unit` is "" if the name has none.
nlohmann::ordered_json TypesJson(const LcmTypes& types);

/// For each type by its name: the fingerprint as "0x" and 16 digits.
nlohmann::ordered_json FingerprintsJson(const LcmTypes& types);

/// The channels of services/graph.h in their order: `id` (the place in kChannels), `name`, `type`,
/// `from`, `what`. STATUS and RESEND, which several roles send, are `from` "everyone".
nlohmann::ordered_json ChannelsJson();

/// The JSON schema of what DecodeJson() makes of a type. Each field has one type only, because
/// Foxglove's and Lichtblick's readers refuse schemas with several. So the schema does not say that
/// an integer beyond 2^53 is a string and that a number which is not finite is null.
nlohmann::ordered_json SchemaJson(const LcmTypes& types, const LcmStruct& type);

}  // namespace fogline::web
