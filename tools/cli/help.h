// Help texts that fit a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace fogline::cli {

/// Maximum length of a line of a help text.
inline constexpr std::size_t kHelpColumns = 100;

/// A validator for a real number in a closed range; it refuses NaN.
CLI::Validator NumberIn(double least, double most);

/// CLI11's formatter of help texts, with wrapped descriptions of options.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_option_desc(const CLI::Option* option) const override;
};

/// Meanings of a verb's exit codes. Every verb may also end with 2 (bad input) and 3 (failure at
/// run time).
struct ExitMeanings {
  std::string_view done = "done";
  std::string_view check_failed = "";  // "": the verb checks nothing
  bool interruptible = false;
};

/// Adds the exit codes to the help of `command`, before the text that is set by footer().
void ShowExitCodes(CLI::App& command, const ExitMeanings& meanings = {});

/// The help of `app`, or of one of its verbs.
std::string HelpText(const CLI::App& app, const CLI::App& of);

}  // namespace fogline::cli
