// Overrides of single fields from the command line: --set /arbitrator/threshold=0.8.
#pragma once

#include <cstdint>
#include <string_view>

#include "scenario/json.h"
#include "scenario/mistakes.h"

namespace fogline {

/// Puts the value of "/pointer=value" into the tree, in place of what is there, and makes missing
/// sections on the way. The value is JSON, or else a plain text. Whether it suits its field shows
/// when the tree is read, as for values of the file; places within it have source `source`.
void ApplyOverride(std::string_view text, std::uint32_t source, JsonValue& root,
                   MistakeList& mistakes);

}  // namespace fogline
