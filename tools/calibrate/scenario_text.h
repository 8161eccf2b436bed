// Changes single values in the text of a scenario file and leaves the rest of it as its author
// wrote it: order, layout, blanks.
#pragma once

#include <string>
#include <string_view>

namespace fogline {

/// `text` with `json` as the value at `pointer`. A key that is not there, and the sections on the
/// way to it, come last in their object, laid out as the keys before them.
/// @pre text and json are JSON; every index in the pointer is that of an item
std::string WithValue(std::string_view text, std::string_view pointer, std::string_view json);

/// The same for an override "/pointer=value", whose value is JSON or else a plain text.
std::string WithOverride(std::string_view text, std::string_view override_text);

}  // namespace fogline
