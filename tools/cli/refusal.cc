#include "tools/cli/refusal.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "services/runtime/process/program_options.h"

namespace fogline::cli {
namespace {

/// The user's word for a subcommand of this command: the program has verbs, and a verb has actions.
std::string_view KindOfVerb(const CLI::App& command) {
  return command.get_parent() == nullptr ? "verb" : "action";
}

/// The verbs that have this option, such as "fogline run, table"; "" if no verb has this option.
std::string VerbsWith(const CLI::App& app, const std::string& option) {
  std::string verbs;
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (verb->get_option_no_throw(option) == nullptr) continue;
    verbs += (verbs.empty() ? app.get_name() + " " : ", ") + verb->get_name();
  }
  return verbs;
}

/// The value that the user wanted to give to `field`, from the words "--threshold=0.8", or from
/// "--threshold" and "0.8"; "VALUE" if the words contain no value.
std::string ValueFor(const Field& field, const std::vector<std::string>& words) {
  const std::string& option = words.front();
  if (const std::size_t at = option.find('='); at != std::string::npos) {
    return Shown(option.substr(at + 1));
  }
  if (words.size() > 1) {
    const std::string& word = words[1];
    double ignored = 0;
    if (CLI::detail::lexical_cast(word, ignored)) return word;
    const auto* choice = field.As<ChoiceField>();
    if (choice != nullptr && std::ranges::count(choice->names, word) > 0) return word;
  }
  return "VALUE";
}

/// A hint for an unknown option that resembles fields of the scenario. The hint says how to set
/// these fields. "" if the option resembles no field.
std::string FieldHint(const std::string& option, const std::vector<std::string>& words) {
  std::string word = option.substr(std::min(option.find_first_not_of('-'), option.size()));
  std::ranges::replace(word, '-', '_');
  std::vector<const Field*> fields;
  std::vector<std::string_view> names;
  for (const Field& field : Catalogue()) {
    if (field.As<SectionField>() != nullptr || field.pointer.find('*') != std::string::npos)
      continue;
    fields.push_back(&field);
    names.push_back(field.name);
  }
  const auto meant = Nearest(word, names);
  if (!meant) return "";
  std::string hint;
  for (const Field* field : fields) {
    if (field->name != *meant) continue;
    hint += hint.empty() ? fmt::format("; a field of the scenario is set with --set {}={}",
                                       field->pointer, ValueFor(*field, words))
                         : fmt::format(" or {}", field->pointer);
  }
  return hint;
}

/// A hint for a word such as "-run.lcm", which may be the name of a file. "" if the word looks like
/// options.
std::string FileHint(const std::string& word) {
  const bool is_name = !word.starts_with("--") && word.find_first_of("./") != std::string::npos;
  return is_name ? fmt::format("; a file of this name is {}", QuoteShort("./" + word)) : "";
}

/// Explains the word that `command` does not accept. @param words this word and the words after it
std::string Misfit(const CLI::App& app, const CLI::App& command,
                   const std::vector<std::string>& words) {
  const std::string& word = words.front();
  if (word.starts_with("-")) {
    const std::string name = word.substr(0, word.find('='));
    std::string hint = runtime::OptionMeant(command, name);
    if (hint.empty() && !VerbsWith(command, name).empty()) {
      hint = fmt::format("; an option stands after its {}", KindOfVerb(command));
    }
    if (const std::string verbs = VerbsWith(app, name); hint.empty() && !verbs.empty()) {
      hint = fmt::format("; it is an option of {}", verbs);
    }
    if (hint.empty() && command.get_option_no_throw("--set") != nullptr) {
      hint = FieldHint(name, words);
    }
    if (hint.empty()) hint = FileHint(word);
    return fmt::format("no option {}{}", QuoteShort(name), hint);
  }
  if (!command.get_subcommands({}).empty()) return NoSuchVerb(command, word);
  return fmt::format("{} is one argument too many", QuoteShort(word));
}

/// The commands of a parsed command line: `app`, its verb, and the action of the verb.
std::vector<const CLI::App*> CommandsOf(const CLI::App& app) {
  std::vector<const CLI::App*> commands{&app};
  while (!commands.back()->get_subcommands().empty()) {
    commands.push_back(commands.back()->get_subcommands().front());
  }
  return commands;
}

std::string NameOf(const std::vector<const CLI::App*>& commands) {
  std::string name;
  for (const CLI::App* command : commands) {
    name += (name.empty() ? "" : " ") + command->get_name();
  }
  return name;
}

std::string OneLine(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return EscapeControls(text);
}

}  // namespace

std::string CommandName(const CLI::App& app) { return NameOf(CommandsOf(app)); }

std::string NoSuchVerb(const CLI::App& command, const std::string& word) {
  std::vector<std::string_view> verbs;
  for (const CLI::App* verb : command.get_subcommands({})) verbs.push_back(verb->get_name());
  const auto meant = Nearest(word, verbs);
  const bool is_program = command.get_parent() == nullptr;
  return fmt::format(
      "no {} {}{}", KindOfVerb(command), QuoteShort(word),
      meant || is_program ? DidYouMean(meant) : fmt::format("; the actions are {}", Names(verbs)));
}

std::string UnknownVerb(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  if (!app.get_subcommands().empty() || words.empty()) return "";
  return fmt::format("{0}: error: {1} (see {0} --help)", app.get_name(), Misfit(app, app, words));
}

void RefuseIgnoredValues(CLI::App& app) {
  for (CLI::App* verb : app.get_subcommands({})) {
    for (CLI::Option* option : verb->get_options()) {
      const std::string type = option->get_type_name();
      if (type.starts_with("INT") || type.starts_with("UINT")) runtime::ReadAsDecimal(*option);
      runtime::RefuseEmptyText(*option);
      if (option->get_items_expected_max() == 0) option->disable_flag_override();
    }
    RefuseIgnoredValues(*verb);
  }
}

std::vector<std::string> SeparateEmptyValues(const std::vector<std::string>& words) {
  std::vector<std::string> separate;
  const auto end_of_options = std::ranges::find(words, "--");
  for (auto word = words.begin(); word != words.end(); ++word) {
    const bool is_empty =
        word < end_of_options && word->starts_with("--") && word->find('=') == word->size() - 1;
    separate.push_back(is_empty ? word->substr(0, word->size() - 1) : *word);
    if (is_empty) separate.emplace_back();
  }
  return separate;
}

std::string Refusal(const CLI::App& app, const CLI::ParseError& error) {
  std::vector<const CLI::App*> commands = CommandsOf(app);
  const auto code = static_cast<CLI::ExitCodes>(error.get_exit_code());
  // In these cases a wrong word may be the real mistake. For example, a command lacks an argument
  // because the argument's word was taken for an option, or stands before the command's name.
  const bool may_misfit = commands.size() == 1 || code == CLI::ExitCodes::ExtrasError ||
                          code == CLI::ExitCodes::RequiredError;
  // The error is about the first wrong word. remaining() has the words that a command does not
  // accept, so the first wrong word belongs to the first command with such words.
  const auto misfit = std::ranges::find_if(
      commands, [](const CLI::App* command) { return !command->remaining().empty(); });
  std::string what = OneLine(runtime::WhatIsWrong(error));
  if (may_misfit && misfit != commands.end()) {
    what = Misfit(app, **misfit, (*misfit)->remaining());
    commands.erase(misfit + 1, commands.end());
  }
  const std::string name = NameOf(commands);
  return fmt::format("{}: error: {} (see {} --help)", name, what, name);
}

}  // namespace fogline::cli
