#include "tools/fogline/refusal.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "scenario/wording.h"

namespace fogline {
namespace {

std::vector<std::string_view> VerbsOf(const CLI::App& app) {
  std::vector<std::string_view> names;
  for (const CLI::App* verb : app.get_subcommands({})) names.push_back(verb->get_name());
  return names;
}

std::vector<std::string> OptionsOf(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// Says which word `command` has no use for.
std::string Misfit(const CLI::App& command, const std::string& word) {
  if (word.starts_with("-")) {
    const std::vector<std::string> options = OptionsOf(command);
    const std::vector<std::string_view> views(options.begin(), options.end());
    const std::string name = word.substr(0, word.find('='));
    return fmt::format("no option {}{}", QuoteShort(name), DidYouMean(Nearest(name, views)));
  }
  const std::vector<std::string_view> verbs = VerbsOf(command);
  if (verbs.empty()) return fmt::format("{} is one argument too many", QuoteShort(word));
  return fmt::format("no verb {}{}", QuoteShort(word), DidYouMean(Nearest(word, verbs)));
}

std::string OneLine(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

}  // namespace

std::string CommandName(const CLI::App& app) {
  const std::vector<CLI::App*> verbs = app.get_subcommands();
  return verbs.empty() ? app.get_name() : app.get_name() + " " + verbs.front()->get_name();
}

std::string Refusal(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> verbs = app.get_subcommands();
  const CLI::App& command = verbs.empty() ? app : *verbs.front();
  const std::vector<std::string> misfits = command.remaining();
  const bool is_extra = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  const bool is_misfit = !misfits.empty() && (verbs.empty() || is_extra);
  std::string what = is_misfit ? Misfit(command, misfits.front()) : OneLine(error.what());
  if (verbs.empty() && misfits.empty()) what = "no verb is given";
  const std::string name = CommandName(app);
  return fmt::format("{}: error: {} (see {} --help)", name, what, name);
}

}  // namespace fogline
