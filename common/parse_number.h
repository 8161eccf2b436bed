// Reads a number from a text.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace fogline {

/// The number, if the whole text is one number that fits into the type; otherwise nullopt.
template <class Number>
std::optional<Number> ParseNumber(std::string_view text) {
  Number number{};
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, number);
  if (error != std::errc() || end != last) return std::nullopt;
  return number;
}

}  // namespace fogline
