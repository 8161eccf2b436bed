// Changes single values in the text of a scenario file. The order, layout and blanks of the rest
// stay.
#pragma once

#include <string>
#include <string_view>

namespace fogline::calibrate {

/// `text` with `json` as the value at `pointer`. A missing key is added at the end of its object,
/// with the layout of the keys before it. The same holds for missing sections on the way to the
/// key.
/// @pre `text` and `json` are JSON; every index in the pointer is that of an existing item
std::string WithValue(std::string_view text, std::string_view pointer, std::string_view json);

/// The same for an override "/pointer=value". Its value is JSON or, failing that, plain text.
std::string WithOverride(std::string_view text, std::string_view override_text);

}  // namespace fogline::calibrate
