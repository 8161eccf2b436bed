// What the command line says of words that it cannot follow.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace fogline {

/// "fogline", or "fogline VERB" once the verb is known: what every message begins with.
std::string CommandName(const CLI::App& app);

/// What is said to `fogline levitate --help`, which asks for the help of no verb; "" if that is not
/// what was asked.
std::string UnknownVerb(const CLI::App& app);

/// `no verb "tabel"; did you mean "table"?`
std::string NoSuchVerb(const CLI::App& app, const std::string& word);

/// A refused command line as one line: "fogline VERB: error: ... (see fogline VERB --help)".
std::string Refusal(const CLI::App& app, const CLI::ParseError& error);

}  // namespace fogline
