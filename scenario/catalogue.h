// Every field of a scenario by its JSON pointer: for explanations, overrides and suggestions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fogline {

/// A section, a list, a list's item or a field.
struct FieldInfo {
  std::string pointer;       // a list's item has the segment *
  bool is_section = false;   // a section, the whole scenario, or an item with fields
  std::string allowed;       // such as "a number in [0, 70] m/s"
  std::string default_text;  // with unit; "" for what has no default of its own
  std::string doc;
  std::string_view source;
  std::span<const std::string_view> choices;
  std::span<const std::string_view> choice_docs;
};

/// All of them, each section followed by what is in it. The first one is the whole scenario, "/".
const std::vector<FieldInfo>& Catalogue();

/// The index that a segment of a pointer is: digits, no leading zero (RFC 6901, section 4).
std::optional<std::size_t> ListIndex(std::string_view segment);

/// What `pointer` means, a list's index standing for any; null if there is no such field.
const FieldInfo* FindField(std::string_view pointer);

/// `pointer`, or the part of it that there is; at least "/".
std::string NearestKnownPointer(std::string_view pointer);

/// The first field of this name in any section, lists' items aside.
std::optional<std::string_view> FindName(std::string_view name);

/// The field that an unknown pointer may mean: one that is spelt alike (with the same indices), or
/// one of the same name in another section.
std::optional<std::string> SuggestPointer(std::string_view pointer);

}  // namespace fogline
