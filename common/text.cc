#include "common/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace fogline {
namespace {

// Longest excerpt of a user's text in a message, in bytes.
constexpr std::size_t kMaxExcerpt = 100;

// Longest word that gets a suggestion, in bytes. The time for computing an edit distance grows with
// the product of the lengths.
constexpr std::size_t kMaxCompared = 64;

// A suggestion may differ from the word by one edit for every three characters. One edit is always
// allowed. If a word of at least kMinBeginning bytes is the beginning of a name (for example the
// name without its unit), the distance counts as one edit.
constexpr std::size_t kCharactersPerEdit = 3;
constexpr std::size_t kMinBeginning = 2;

// Size in bytes of the control character (C0, DEL, C1 in UTF-8) at the beginning of `text`; 0 if
// `text` does not begin with a control character.
std::size_t ControlCharacterSize(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x20 || byte(0) == 0x7f) return 1;
  if (byte(0) == 0xc2 && text.size() > 1 && byte(1) >= 0x80 && byte(1) < 0xa0) return 2;
  return 0;
}

// The character at the beginning of a text. It has no code point if the text does not begin with
// valid UTF-8.
struct Character {
  std::size_t bytes = 1;
  std::optional<char32_t> code_point;
};

Character FirstCharacter(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return {.bytes = 1, .code_point = byte(0)};
  // The number of leading ones of the first byte is the number of bytes of the character.
  const std::size_t bytes = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
  if (byte(0) < 0xc2 || byte(0) > 0xf4 || text.size() < bytes) return {};
  char32_t code_point = byte(0) & (0x7fU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) >> 6U) != 2) return {};
    code_point = (code_point << 6U) | (byte(i) & 0x3fU);
  }
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800,
                                           0x10000};  // least code point by length
  const bool is_surrogate = code_point >= 0xd800 && code_point < 0xe000;
  if (code_point < kLeast[bytes] || code_point > 0x10ffff || is_surrogate) return {};
  return {.bytes = bytes, .code_point = code_point};
}

// Whether `c` is a control character (Unicode's general category Cc), an invisible character of
// category Cf, or a separator of lines or paragraphs.
bool IsUnseen(char32_t c) {
  struct Block {
    char32_t first, last;
  };
  constexpr std::array kUnseen{Block{0x0, 0x1f},      Block{0x7f, 0x9f},      Block{0xad, 0xad},
                               Block{0x61c, 0x61c},   Block{0x180e, 0x180e},  Block{0x200b, 0x200f},
                               Block{0x2028, 0x202e}, Block{0x2060, 0x206f},  Block{0xfeff, 0xfeff},
                               Block{0xfff9, 0xfffb}, Block{0xe0000, 0xe007f}};
  return std::ranges::any_of(
      kUnseen, [c](const Block& block) { return c >= block.first && c <= block.last; });
}

// The character as JSON escapes it: one or two units of UTF-16.
std::string Escaped(char32_t c) {
  if (c < 0x10000) return fmt::format("\\u{:04x}", static_cast<std::uint32_t>(c));
  const std::uint32_t rest = c - 0x10000;
  return fmt::format("\\u{:04x}\\u{:04x}", 0xd800 + (rest >> 10U), 0xdc00 + (rest & 0x3ffU));
}

std::string Shorten(std::string_view text) {
  if (text.size() <= kMaxExcerpt) return std::string(text);
  std::size_t end = kMaxExcerpt;
  while (end > 0 && (static_cast<unsigned char>(text[end]) >> 6U) == 2) --end;
  return std::string(text.substr(0, end)) + "...";
}

}  // namespace

std::string NumberText(double value) {
  if (value == 0.0 && std::signbit(value)) return "-0.0";
  return fmt::format("{}", value);
}

std::string TimeText(double time_s) {
  constexpr double kMicrosecondsPerSecond = 1e6;
  return NumberText(std::round(time_s * kMicrosecondsPerSecond) / kMicrosecondsPerSecond);
}

std::string EscapeControls(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Character first = FirstCharacter(text);
    if (!first.code_point) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    } else if (IsUnseen(*first.code_point)) {
      out += Escaped(*first.code_point);
    } else {
      out += text.substr(0, first.bytes);
    }
    text.remove_prefix(first.bytes);
  }
  return out;
}

std::string EscapeLines(std::string_view text) {
  std::string lines;
  while (true) {
    const std::size_t end = text.find('\n');
    lines += EscapeControls(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    lines += '\n';
    text.remove_prefix(end + 1);
  }
}

std::string PathText(const std::filesystem::path& file) { return EscapeControls(file.native()); }

std::string Printable(std::string_view text) {
  std::string printable(text);
  std::ranges::replace_if(
      printable, [](char c) { return c < ' ' || c > '~'; }, '?');
  return printable;
}

std::string Quote(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    if (c == '"' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return '"' + EscapeControls(escaped) + '"';
}

std::string QuoteShort(std::string_view text) { return Quote(Shorten(text)); }

std::string Shown(std::string_view text) { return EscapeControls(Shorten(text)); }

std::string WithUnit(std::string_view text, std::string_view unit) {
  return unit.empty() ? std::string(text) : fmt::format("{} {}", text, unit);
}

std::string Names(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) {
    if (!text.empty()) text += ", ";
    text += Quote(name);
  }
  return text;
}

std::size_t EditDistance(std::string_view a, std::string_view b) {
  // Row i has the distances between the first i characters of a and every prefix of b. Three rows
  // are stored: i - 2 (`before`), i - 1 (`previous`) and i (`current`).
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> previous(b.size() + 1);
  std::vector<std::size_t> current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) current[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(before, previous);
    std::swap(previous, current);
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before[j - 2] + 1);
      }
    }
  }
  return current[b.size()];
}

std::optional<std::string_view> Nearest(std::string_view word,
                                        std::span<const std::string_view> candidates) {
  if (word.size() > kMaxCompared) return std::nullopt;
  std::optional<std::string_view> nearest;
  std::size_t least = std::max<std::size_t>(1, word.size() / kCharactersPerEdit) + 1;
  for (const std::string_view candidate : candidates) {
    const bool begins = word.size() >= kMinBeginning && candidate.starts_with(word);
    const std::size_t distance = begins && candidate != word ? 1 : EditDistance(word, candidate);
    if (distance >= least || distance >= candidate.size()) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string DidYouMean(std::optional<std::string_view> suggestion) {
  return suggestion ? fmt::format("; did you mean {}?", Quote(*suggestion)) : std::string();
}

std::size_t CountCharacters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6U) != 2; }));
}

bool HasControlCharacter(std::string_view text) {
  for (; !text.empty(); text.remove_prefix(1)) {
    if (ControlCharacterSize(text) > 0) return true;
  }
  return false;
}

bool IsUtf8(std::string_view text) {
  try {
    static_cast<void>(nlohmann::json(text).dump());
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

std::size_t SkipByteOrderMark(std::string_view text) {
  return text.starts_with("\xef\xbb\xbf") ? 3 : 0;
}

}  // namespace fogline
