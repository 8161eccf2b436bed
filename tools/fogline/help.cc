#include "tools/fogline/help.h"

#include <sstream>

namespace fogline {
namespace {

constexpr std::size_t kOptionColumns = 34;  // of the names of options

}  // namespace

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

}  // namespace fogline
