// Wrong command lines, and the error messages for them.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace fogline::cli {

/// The beginning of every error message: "fogline VERB" if the verb is known, otherwise "fogline".
/// The action of a verb follows the verb, as in "fogline experiment run".
std::string CommandName(const CLI::App& app);

/// The error for a command line that has words but no verb, such as `fogline levitate --help`; ""
/// for any other command line.
std::string UnknownVerb(const CLI::App& app);

/// The error text for an unknown verb of a program, or an unknown action of a verb, such as `no
/// verb "tabel"; did you mean "table"?`
std::string NoSuchVerb(const CLI::App& command, const std::string& word);

/// Makes the verbs of `app`, and their actions, refuse values that they would otherwise ignore:
/// - an empty text for an option or argument. It often comes from a shell variable that is not set,
///   as in --log "$UNSET".
/// - a value for a flag, as in --force=no.
/// Whole numbers are read as decimal, also with leading zeros.
void RefuseIgnoredValues(CLI::App& app);

/// The words of a command line. A word such as "--log=" becomes two words, "--log" and "". Without
/// this change, CLI11 would take the next word as the value of --log.
std::vector<std::string> SeparateEmptyValues(const std::vector<std::string>& words);

/// The error message, in one line, for a refused command line: "fogline VERB: error: ... (see
/// fogline VERB --help)".
std::string Refusal(const CLI::App& app, const CLI::ParseError& error);

}  // namespace fogline::cli
