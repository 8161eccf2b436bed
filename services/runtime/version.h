// Which build this is.
#pragma once

#include <string>

namespace fogline {

/// Version and message types, such as "0.1.0, message types 4fe3a21b90c7d655": what `--version` of
/// every program prints. Programs that work together have it in common.
std::string VersionText();

}  // namespace fogline
