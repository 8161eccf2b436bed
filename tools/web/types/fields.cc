#include "tools/web/types/fields.h"

#include <algorithm>
#include <charconv>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"

namespace fogline::web {
namespace {

[[noreturn]] void Fail(std::string_view path) {
  throw InputError(fmt::format(
      "{} is no field: write a field like \"host_gap_m\", \"header.step\" or \"follower_gap_m[0]\"",
      QuoteShort(path)));
}

/// Removes "[INDEX]" from the front of `text`. @return the index
std::size_t TakeIndex(std::string_view path, std::string_view& text) {
  std::size_t index = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, index);
  if (error != std::errc() || stop == end || *stop != ']') Fail(path);
  text.remove_prefix(static_cast<std::size_t>(stop + 1 - text.data()));
  return index;
}

}  // namespace

std::vector<PathPart> ParsePath(std::string_view path) {
  std::vector<PathPart> parts;
  std::string_view rest = path;
  while (true) {
    PathPart& part = parts.emplace_back();
    const std::size_t length = std::min(rest.find_first_of(".[]"), rest.size());
    if (length == 0) Fail(path);
    part.name = rest.substr(0, length);
    rest.remove_prefix(length);
    while (rest.starts_with('[')) part.indices.push_back(TakeIndex(path, rest));
    if (rest.empty()) return parts;
    if (!rest.starts_with('.')) Fail(path);
    rest.remove_prefix(1);
  }
}

}  // namespace fogline::web
