// fogline help: prints the help of the program, or of a verb.
#include <memory>
#include <string>

#include <fmt/core.h>

#include "common/errors.h"
#include "tools/cli/help.h"
#include "tools/cli/refusal.h"
#include "tools/fogline/verbs.h"

namespace fogline {
namespace {

/// @throws InputError if there is no such verb
const CLI::App& FindVerb(const CLI::App& app, const std::string& name) {
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (verb->get_name() == name) return *verb;
  }
  throw InputError(fmt::format("error: {} (see fogline --help)", cli::NoSuchVerb(app, name)));
}

}  // namespace

void AddHelp(CLI::App& app, cli::Action& action) {
  CLI::App* verb = app.add_subcommand("help", "Show this text, or the help of a verb");
  const auto name = std::make_shared<std::string>();
  verb->add_option("VERB", *name, "Verb to explain (default: the list of all)");
  cli::ShowExitCodes(*verb);
  verb->footer("Examples:\n  fogline help\n  fogline help table");
  verb->callback([&app, &action, name] {
    action = [&app, name] {
      fmt::print("{}", cli::HelpText(app, name->empty() ? app : FindVerb(app, *name)));
      return kDone;
    };
  });
}

}  // namespace fogline
