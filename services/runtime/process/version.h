// The text of --version.
#pragma once

#include <string>

namespace fogline::runtime {

/// Version and message types, such as "0.1.0, message types 4fe3a21b90c7d655". `--version` of the
/// roles, of `fogline` and of its verbs that are programs of their own (tools/cli/own_program.h)
/// prints this text. Programs that work together print the same text. fogline-relay carries
/// messages of any type, so it prints only its version.
std::string VersionText();

}  // namespace fogline::runtime
