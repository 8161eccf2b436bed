// The fields of a message, for people.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fogline/status_t.hpp"
#include "services/runtime/wire/wire.h"

namespace fogline::watch {

/// Lines "name   value", one for each field of a message and for each element of an array. For an
/// unknown channel, or for a message that cannot be decoded, the lines show the first bytes in
/// hexadecimal. Text from the network is made safe to print.
std::vector<std::string> FieldLines(std::string_view channel, runtime::Bytes message);

std::vector<std::string> FieldLines(const status_t& status);

}  // namespace fogline::watch
