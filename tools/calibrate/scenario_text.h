// Changes single values in the text of a scenario file. The rest of the text keeps its order,
// layout and blanks.
#pragma once

#include <string>
#include <string_view>

namespace fogline::calibrate {

/// `text` with `json` as the value at `pointer`. A missing key is added at the end of its object,
/// with the layout of the keys before it. Missing sections on the way to the key are added in the
/// same way.
/// @pre `text` and `json` are JSON; every index in the pointer belongs to an existing item
std::string WithValue(std::string_view text, std::string_view pointer, std::string_view json);

/// `text` changed by an override "/pointer=value". A value that is not JSON becomes a JSON string.
std::string WithOverride(std::string_view text, std::string_view override_text);

}  // namespace fogline::calibrate
