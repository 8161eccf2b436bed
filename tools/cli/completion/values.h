// The values that an option or argument of a command line can have.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "tools/cli/completion/completion.h"

namespace fogline::cli {

/// The values of an option or argument that begin with `begun`. The values are the names that the
/// option's check allows, fields of the scenario, roles, transports or verbs. For the name of a
/// file, or any other text, the result suggests files instead.
/// @param app the program, which has the verbs
Completion ValuesOf(const CLI::App& app, const CLI::Option& option, const std::string& begun);

/// Adds the verbs of `command` that begin with `begun`.
void AddVerbs(const CLI::App& command, const std::string& begun, Completion& completion);

}  // namespace fogline::cli
