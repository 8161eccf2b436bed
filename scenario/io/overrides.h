// Overrides of single fields from the command line: --set /arbitrator/threshold=0.8.
#pragma once

#include <cstdint>
#include <string_view>

#include "scenario/io/diagnostic_list.h"
#include "scenario/io/json.h"

namespace fogline {

/// Puts the value of "/pointer=value" into the tree, replaces the value that is there, and adds
/// missing sections of the path. If the value is not JSON, it is taken as plain text. Reading the
/// tree checks whether the value suits its field, as for values of the file. Places in it have
/// source `source`.
void ApplyOverride(std::string_view text, std::uint32_t source, JsonValue& root,
                   DiagnosticList& mistakes);

}  // namespace fogline
