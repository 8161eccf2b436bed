// The values that a field of a scenario allows, in words.
#pragma once

#include <string>

#include "scenario/sections/field.h"

namespace fogline {

/// The range of a number with its unit, such as "[0, 70] m/s".
std::string Range(const NumberSpec& spec);
std::string Range(const IntegerSpec& spec);

/// The values that a field allows, such as "a number in [0, 70] m/s".
std::string Allowed(const NumberSpec& spec);
std::string Allowed(const IntegerSpec& spec);
std::string AllowedText();

/// The allowed number of items of a list, such as "0 to 100".
std::string Range(const ListSpec& spec);

}  // namespace fogline
