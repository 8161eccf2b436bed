// Numbers in binary frames: little endian, as in browsers' typed arrays.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace fogline::web {

template <class Number>
void PutLittleEndian(Number number, std::string& to) {
  auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
  to.append(bytes.data(), bytes.size());
}

/// Removes a number from the beginning of a text, and returns it. @pre the text is long enough
template <class Number>
Number TakeLittleEndian(std::string_view& from) {
  std::array<char, sizeof(Number)> bytes{};
  std::memcpy(bytes.data(), from.data(), bytes.size());
  if constexpr (std::endian::native == std::endian::big) std::ranges::reverse(bytes);
  from.remove_prefix(sizeof(Number));
  return std::bit_cast<Number>(bytes);
}

}  // namespace fogline::web
