// Error messages for wrong command lines.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace fogline::cli {

/// "fogline", or "fogline VERB" once the verb is known: the beginning of every message.
std::string CommandName(const CLI::App& app);

/// The error for a command line that has words but no verb, such as `fogline levitate --help`; ""
/// for any other command line.
std::string UnknownVerb(const CLI::App& app);

/// `no verb "tabel"; did you mean "table"?`
std::string NoSuchVerb(const CLI::App& app, const std::string& word);

/// A refused command line as one line: "fogline VERB: error: ... (see fogline VERB --help)".
std::string Refusal(const CLI::App& app, const CLI::ParseError& error);

}  // namespace fogline::cli
