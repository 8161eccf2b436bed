// The files of lcmtypes/, built into the program (lcm_texts.cmake writes the definition).
#pragma once

#include <span>
#include <string_view>

namespace fogline::web {

struct LcmText {
  std::string_view file;  // its name, such as "truth_t.lcm"
  std::string_view text;
};

/// All files, by name.
std::span<const LcmText> LcmTexts();

}  // namespace fogline::web
