// Help texts that fit a terminal.
#pragma once

#include <cstddef>
#include <string>

#include <CLI/CLI.hpp>

namespace fogline {

/// No line of a help text is longer.
inline constexpr std::size_t kHelpColumns = 100;

/// A real number of a closed range, which NaN is not in.
CLI::Validator NumberIn(double least, double most);

/// CLI11's help with the descriptions of options wrapped.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace fogline
