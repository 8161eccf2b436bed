// The version of this build, and the text of --version.
#pragma once

#include <string>
#include <string_view>

namespace fogline::runtime {

/// The version of this build, such as "0.2.0" (semantic versions, see CHANGELOG.md).
std::string_view Version();

/// Version, message types, and the LCM with which this program was built, such as "0.2.0, message
/// types 4fe3a21b90c7d655, LCM 1.3.1". `--version` of the roles, of `fogline` and of its verbs that
/// are separate programs (tools/cli/own_program.h) prints this text. All programs of one build
/// print the same text. fogline-relay carries messages of any type, so it prints only its version.
std::string VersionText();

}  // namespace fogline::runtime
