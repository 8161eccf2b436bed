// A message's bytes on the wire of LCM as bytes of Protocol Buffers.
#pragma once

#include <string>

#include "tools/web/types/lcm_types.h"

namespace fogline::mcap {

/// Appends the message in the encoding that DescriptorSetOf() describes. Every member is written,
/// zeros too, with all its bits.
/// @param message with its fingerprint
/// @return false if the bytes are not exactly one message of this type; `to` then has a part of it
bool AppendProtobuf(const web::LcmTypes& types, const web::LcmStruct& type, web::Bytes message,
                    std::string& to);

}  // namespace fogline::mcap
