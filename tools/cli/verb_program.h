// Shared code of the verbs' main programs: it parses the command line and turns errors into exit
// codes.
#pragma once

#include <initializer_list>

#include <CLI/CLI.hpp>

#include "tools/cli/action.h"

namespace fogline::cli {

/// Adds a verb to the command line; see tools/fogline/verbs.h.
using AddVerb = void (*)(CLI::App& app, Action& action);

/// Reads the command line "fogline VERB ...", runs the verb, and prints the verb's error, if any.
/// @return the exit code
int RunVerbs(int argc, char** argv, std::initializer_list<AddVerb> verbs);

/// Does the work of RunVerbs() for the program of a single verb. Its command line has no VERB.
int RunOneVerb(int argc, char** argv, AddVerb verb);

}  // namespace fogline::cli
