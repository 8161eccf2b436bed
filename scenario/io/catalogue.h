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
  std::string default_text;  // with unit; "" for a section, list or item without a default
  std::string doc;
  std::string_view source;
  std::span<const std::string_view> choices;
  std::span<const std::string_view> choice_docs;
};

/// All fields, sections, lists and items. The contents of a section follow the section. The first
/// entry is the whole scenario, "/".
const std::vector<FieldInfo>& Catalogue();

/// The index that a segment of a pointer states: digits without a leading zero (RFC 6901, section
/// 4). Nothing if the segment is not an index.
std::optional<std::size_t> ListIndex(std::string_view segment);

/// The field with this pointer; null if there is none. Any index finds the item of a list.
const FieldInfo* FindField(std::string_view pointer);

/// The longest beginning of `pointer` that names a field or section; at least "/".
std::string NearestKnownPointer(std::string_view pointer);

/// Pointer of the first field with this name in any section, except fields in items of lists.
std::optional<std::string_view> FindName(std::string_view name);

/// The field that an unknown pointer may mean: one with a similar spelling (with the same indices),
/// or one with the same name in another section.
std::optional<std::string> SuggestPointer(std::string_view pointer);

}  // namespace fogline
