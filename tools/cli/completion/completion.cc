#include "tools/cli/completion/completion.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

#include <fmt/core.h>

#include "tools/cli/completion/values.h"

namespace fogline::cli {
namespace {

/// Whether an option takes further values after its first one, as in --merge A B C.
bool TakesMore(const CLI::Option& option) {
  return option.get_items_expected_max() > 1 && option.get_allow_extra_args();
}

/// The part of a command line before the cursor, read word by word.
class CommandLine {
 public:
  explicit CommandLine(const CLI::App& app) : app_(app), command_(&app) {}

  void Read(const std::string& word) {
    const bool is_option = !only_arguments_ && word.size() > 1 && word.starts_with('-');
    if (awaiting_ != nullptr && !(is_option && has_value_)) {
      has_value_ = true;
      if (!TakesMore(*awaiting_)) awaiting_ = nullptr;
      return;
    }
    awaiting_ = nullptr;
    if (!only_arguments_ && word == "--") {
      only_arguments_ = true;
    } else if (is_option) {
      ReadOption(word);
    } else if (const CLI::App* verb = Verb(word); verb != nullptr) {
      command_ = verb;
    } else {
      ++arguments_;
    }
  }

  Completion At(const std::string& begun) const {
    const bool is_option = !only_arguments_ && begun.starts_with('-');
    if (awaiting_ != nullptr && !(is_option && has_value_)) {
      return ValuesOf(app_, *awaiting_, begun);
    }
    if (is_option) return OptionsAt(begun);
    Completion completion;
    if (arguments_ == 0) AddVerbs(*command_, begun, completion);
    if (const CLI::Option* argument = Argument(); argument != nullptr) {
      Completion values = ValuesOf(app_, *argument, begun);
      std::ranges::move(values.words, std::back_inserter(completion.words));
      completion.files = values.files;
    }
    return completion;
  }

 private:
  void ReadOption(const std::string& word) {
    const CLI::Option* option = command_->get_option_no_throw(word.substr(0, word.find('=')));
    has_value_ = word.find('=') != std::string::npos;
    const bool waits = option != nullptr && option->get_items_expected_max() > 0;
    if (waits && (!has_value_ || TakesMore(*option))) awaiting_ = option;
  }

  const CLI::App* Verb(const std::string& word) const {
    if (arguments_ > 0) return nullptr;
    for (const CLI::App* verb : command_->get_subcommands({})) {
      if (verb->get_name() == word) return verb;
    }
    return nullptr;
  }

  /// The positional argument at the cursor; nullptr if the command takes no further argument.
  const CLI::Option* Argument() const {
    const auto arguments =
        command_->get_options([](const CLI::Option* option) { return option->get_positional(); });
    if (arguments_ < arguments.size()) return arguments[arguments_];
    if (arguments.empty() || arguments.back()->get_items_expected_max() == 1) return nullptr;
    return arguments.back();
  }

  Completion OptionsAt(const std::string& begun) const {
    if (const std::size_t at = begun.find('='); at != std::string::npos) {
      const CLI::Option* option = command_->get_option_no_throw(begun.substr(0, at));
      if (option == nullptr) return {};
      Completion completion = ValuesOf(app_, *option, begun.substr(at + 1));
      for (Suggestion& word : completion.words) word.word.insert(0, begun, 0, at + 1);
      return completion;
    }
    Completion completion;
    for (const CLI::Option* option : command_->get_options()) {
      if (option->get_group().empty()) continue;
      for (const std::string& name : option->get_lnames()) {
        if (!name.starts_with(begun.substr(std::min<std::size_t>(begun.size(), 2)))) continue;
        if (begun.size() > 1 && begun[1] != '-') continue;
        completion.words.push_back({"--" + name, option->get_description()});
      }
    }
    return completion;
  }

  const CLI::App& app_;
  const CLI::App* command_;                // the program, or the chosen verb
  const CLI::Option* awaiting_ = nullptr;  // the option that may take the next word
  bool has_value_ = false;                 // whether this option has a value already
  bool only_arguments_ = false;            // true after "--"
  std::size_t arguments_ = 0;              // arguments of the command so far
};

}  // namespace

Completion Complete(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return {};
  CommandLine line(app);
  std::for_each(words.begin(), words.end() - 1, [&line](const auto& word) { line.Read(word); });
  return line.At(words.back());
}

std::string ToText(const Completion& completion) {
  std::string text;
  for (const Suggestion& suggestion : completion.words) {
    text += fmt::format("{}\t{}\n", suggestion.word, suggestion.meaning);
  }
  if (!completion.files.empty()) text += fmt::format("@files\t{}\n", completion.files);
  return text;
}

}  // namespace fogline::cli
