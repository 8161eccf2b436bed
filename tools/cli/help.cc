#include "tools/cli/help.h"

#include <sstream>

#include <fmt/core.h>

#include "common/text.h"

namespace fogline::cli {
namespace {

constexpr std::size_t kOptionColumns = 34;  // width of the column with the names of options

}  // namespace

CLI::Validator NumberIn(double least, double most) {
  // This function replaces CLI::Range for real numbers. CLI::Range accepts NaN, and writes a limit
  // with six decimals or three hundred digits. The texts here have the same form as the texts of
  // CLI::Range for whole numbers.
  const auto check = [least, most](const std::string& text) -> std::string {
    double value = 0;
    const bool is_number = CLI::detail::lexical_cast(text, value);
    if (is_number && least <= value && value <= most) return "";
    return fmt::format("Value {} not in range {} to {}", text, NumberText(least), NumberText(most));
  };
  return {check, fmt::format("FLOAT in [{} - {}]", NumberText(least), NumberText(most))};
}

HelpFormatter::HelpFormatter() { column_width(kOptionColumns); }

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  const std::size_t width = kHelpColumns - get_column_width();
  std::istringstream words(CLI::Formatter::make_option_desc(option));
  std::string text;
  std::size_t used = 0;
  for (std::string word; words >> word;) {
    const bool fits = used + 1 + word.size() <= width;
    if (!text.empty()) text += fits ? ' ' : '\n';
    used = fits && !text.empty() ? used + 1 + word.size() : word.size();
    text += word;
  }
  return text;
}

void ShowExitCodes(CLI::App& command, const ExitMeanings& meanings) {
  std::string text = fmt::format("Exit codes: 0 {}", meanings.done);
  if (!meanings.check_failed.empty()) text += fmt::format(", 1 {}", meanings.check_failed);
  text += ", 2 bad input, 3 failure at run time";
  if (meanings.interruptible) text += ", 130 interrupted";
  command.footer([text] { return text + ".\n"; });
}

std::string HelpText(const CLI::App& app, const CLI::App& of) {
  // The formatter is called directly, because CLI11's help() prints something else: app.help()
  // prints the help of the verb that the user has called, and of.help() omits the program's name.
  const std::string name = &of == &app ? app.get_name() : app.get_name() + " " + of.get_name();
  return app.get_formatter()->make_help(&of, name, CLI::AppFormatMode::Normal);
}

}  // namespace fogline::cli
