// Divides a text in LCM's type language into words.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fogline::web {

struct LcmToken {
  enum class Kind : std::uint8_t { kWord, kNumber, kSymbol, kEnd };
  Kind kind = Kind::kEnd;
  std::string text;
  int line = 0;
  /// The lines of comment directly before the token, joined by spaces.
  std::string comment_before;
  /// The comment after the token on the same line.
  std::string comment_behind;
};

/// The words of a text, and a last word of kind kEnd. A comment after a word on the same line
/// belongs to this word. Any other comment belongs to the next word, unless a blank line is between
/// them.
/// @param file name of the file for errors
/// @throws InputError for a character that the language does not have, or a comment without an end
std::vector<LcmToken> LcmTokens(std::string_view text, std::string_view file);

}  // namespace fogline::web
