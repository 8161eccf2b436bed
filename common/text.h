// Parts of messages: numbers, quoted and escaped texts, names, suggestions.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fogline {

/// The shortest text that a reader converts back to the same number. A negative zero is "-0.0".
std::string NumberText(double value);

/// A time in s, rounded to the resolution of a run (microseconds), such as "899.9" for
/// 899.9000000000001.
std::string TimeText(double time_s);

/// Makes a text safe to show in one line of any terminal. Control characters (C0, DEL, C1) and
/// invisible characters that change the text around them (directions of writing, zero width) are
/// escaped as in JSON. A byte that is not UTF-8 is written as "\xff".
std::string EscapeControls(std::string_view text);

/// Escapes a text like EscapeControls(), but keeps line feeds. So a JSON text keeps its lines and
/// its meaning.
std::string EscapeLines(std::string_view text);

/// The name of a file, escaped for a terminal.
std::string PathText(const std::filesystem::path& file);

/// `text` with '?' in place of each byte other than ASCII letters, digits, punctuation and spaces.
/// Use this function for text of unknown encoding from the network.
std::string Printable(std::string_view text);

/// The text as a JSON string: in double quotes, with control characters escaped.
std::string Quote(std::string_view text);

/// The text for a message, in quotes like Quote(). A long text is cut.
std::string QuoteShort(std::string_view text);

/// The text for a message, without quotes. Control characters are escaped, and long texts are cut.
std::string Shown(std::string_view text);

/// `text` and `unit` with a space between them; only `text` if `unit` is "".
std::string WithUnit(std::string_view text, std::string_view unit);

/// The names in double quotes: `"box", "half_sine", "triangle"`.
std::string Names(std::span<const std::string_view> names);

/// Least number of edits that turn `a` into `b`: insertions, deletions, substitutions and swaps of
/// two neighbouring bytes. (The name of this distance is "optimal string alignment". It is the
/// Damerau-Levenshtein distance with the condition that no position is edited twice.)
std::size_t EditDistance(std::string_view a, std::string_view b);

/// The candidate nearest to `word`, if it is near enough for a suggestion. If several candidates
/// are equally near, the result is the first of them.
std::optional<std::string_view> Nearest(std::string_view word,
                                        std::span<const std::string_view> candidates);

/// Returns a text such as `; did you mean "x"?`; "" if there is no suggestion.
std::string DidYouMean(std::optional<std::string_view> suggestion);

/// Number of characters (code points) of valid UTF-8.
std::size_t CountCharacters(std::string_view text);

bool HasControlCharacter(std::string_view text);

bool IsUtf8(std::string_view text);

/// The size of UTF-8's byte order mark in bytes (3) if the text begins with this mark; otherwise 0.
std::size_t SkipByteOrderMark(std::string_view text);

}  // namespace fogline
