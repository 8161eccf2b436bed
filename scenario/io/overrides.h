// Overrides of single fields from the command line: --set /arbitrator/threshold=0.8.
#pragma once

#include <cstdint>
#include <string_view>

#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"

namespace fogline {

/// Puts the value of "/pointer=value" into the tree, in place of any earlier value, and adds
/// missing sections of the path. A value that is not JSON is taken as plain text. ReadScenario()
/// checks later whether the value suits its field, as for values of the file.
/// @param source the index of this override in the list of sources (Place::source)
void ApplyOverride(std::string_view text, std::uint32_t source, JsonValue& root,
                   DiagnosticList& mistakes);

}  // namespace fogline
