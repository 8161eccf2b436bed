// The files of lcmtypes/, built into the program (lcm_texts.cmake writes the definition).
#pragma once

#include <span>
#include <string_view>

namespace fogline::web {

struct LcmText {
  std::string_view file;  // name of the file, such as "truth_t.lcm"
  std::string_view text;
};

/// All files, in the order of their names.
std::span<const LcmText> LcmTexts();

}  // namespace fogline::web
