// The fields of a message, for people.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fogline/status_t.hpp"
#include "services/runtime/wire/wire.h"

namespace fogline::watch {

/// A line "name   value" for each field of a message, and for each value of an array. If the
/// channel is none of Fogline, or the message does not decode: its first bytes in hexadecimal. Text
/// from the network is safe to print.
std::vector<std::string> FieldLines(std::string_view channel, runtime::Bytes message);

std::vector<std::string> FieldLines(const status_t& status);

}  // namespace fogline::watch
