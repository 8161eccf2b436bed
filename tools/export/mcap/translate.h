// Translates the bytes of an LCM message into bytes of Protocol Buffers.
#pragma once

#include <string>

#include "tools/web/types/lcm_types.h"

namespace fogline::mcap {

/// Appends the message in the encoding that DescriptorSetOf() describes. No bit of a value is lost.
/// A member whose value is zero is written, too, although proto3 permits omitting it.
/// @param message an LCM message, with its fingerprint
/// @return false if the bytes are not exactly one message of this type; `to` then has a part of the
///     message
bool AppendProtobuf(const web::LcmTypes& types, const web::LcmStruct& type, web::Bytes message,
                    std::string& to);

}  // namespace fogline::mcap
