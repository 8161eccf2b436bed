#include "tools/calibrate/scenario_text.h"

#include <charconv>
#include <cstddef>
#include <stdexcept>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/json.h"

namespace fogline::calibrate {
namespace {

constexpr std::string_view kBlank = " \t\r\n";

/// Position of the first byte after the value that begins at `begin`.
std::size_t EndOfValue(std::string_view text, std::size_t begin) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = begin; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c != '"') continue;
      quoted = false;
      if (depth == 0) return i + 1;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      ++depth;
    } else if (c == '}' || c == ']') {
      if (depth == 0) return i;
      if (--depth == 0) return i + 1;
    } else if (depth == 0 && (c == ',' || kBlank.find(c) != std::string_view::npos)) {
      return i;
    }
  }
  return text.size();
}

/// The blanks directly before a key. A brace or a comma is before these blanks.
std::string_view BlanksBefore(std::string_view text, std::size_t key) {
  const std::size_t last = text.find_last_not_of(kBlank, key - 1);
  return text.substr(last + 1, key - last - 1);
}

std::string Replaced(std::string_view text, std::size_t begin, std::size_t end,
                     std::string_view by) {
  return fmt::format("{}{}{}", text.substr(0, begin), by, text.substr(end));
}

/// `text` with one more member at the end of an object.
std::string Appended(std::string_view text, const JsonValue& object, std::string_view key,
                     std::string_view json) {
  const auto& members = *object.As<JsonObject>();
  if (members.empty()) {
    const std::size_t begin = object.place.offset;
    return Replaced(text, begin, EndOfValue(text, begin),
                    fmt::format("{{ {}: {} }}", Quote(key), json));
  }
  const JsonMember& last = members.back();
  const std::size_t end = EndOfValue(text, last.value.place.offset);
  return Replaced(
      text, end, end,
      fmt::format(",{}{}: {}", BlanksBefore(text, last.place.offset), Quote(key), json));
}

/// Wraps `json` into objects with the keys of a pointer; the first key is the outermost one.
std::string Wrapped(std::string_view pointer, std::string_view json) {
  if (pointer.empty()) return std::string(json);
  const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
  return fmt::format("{{ {}: {} }}", Quote(pointer.substr(1, end - 1)),
                     Wrapped(pointer.substr(end), json));
}

bool IsJson(std::string_view text) {
  DiagnosticList ignored;
  return ParseJson(text, 0, ignored).has_value();
}

}  // namespace

std::string WithValue(std::string_view text, std::string_view pointer, std::string_view json) {
  DiagnosticList diagnostics;
  const std::optional<JsonValue> root = ParseJson(text, 0, diagnostics);
  if (!root) throw std::invalid_argument("WithValue: not JSON");
  const JsonValue* at = &*root;
  while (!pointer.empty()) {
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    const std::string_view segment = pointer.substr(1, end - 1);
    pointer.remove_prefix(end);
    if (const auto* items = at->As<JsonArray>()) {
      std::size_t index = 0;
      std::from_chars(segment.data(), segment.data() + segment.size(), index);
      at = &items->at(index);
      continue;
    }
    const auto* object = at->As<JsonObject>();
    if (object == nullptr)
      throw std::invalid_argument("WithValue: a parent of the field is not an object");
    const JsonMember* member = FindMember(*object, segment);
    if (member == nullptr) return Appended(text, *at, segment, Wrapped(pointer, json));
    at = &member->value;
  }
  const std::size_t begin = at->place.offset;
  return Replaced(text, begin, EndOfValue(text, begin), json);
}

std::string WithOverride(std::string_view text, std::string_view override_text) {
  const std::size_t equals = override_text.find('=');
  const std::string_view value = override_text.substr(equals + 1);
  return WithValue(text, override_text.substr(0, equals),
                   IsJson(value) ? std::string(value) : Quote(value));
}

}  // namespace fogline::calibrate
