// Every field of a scenario by its JSON pointer: for explanations, overrides and suggestions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "scenario/sections/field_view.h"

namespace fogline {

/// All fields, sections, lists and items of a scenario, with default values. Each list has one
/// item, with the segment * in its pointer. The contents of a section follow the section. All
/// callers share the values, so a caller must not change them.
const FieldList& Catalogue();

/// All fields of an experiment, and all fields of a laboratory, in the form of Catalogue().
const FieldList& ExperimentCatalogue();
const FieldList& LabCatalogue();

/// Finds the field with this pointer, or returns null. Any index in the pointer finds the one item
/// of its list. "/" and "" find the whole scenario, which is not in Catalogue().
const Field* FindField(std::string_view pointer);

/// The longest beginning of `pointer` that names a field or section; at least "/".
std::string NearestKnownPointer(std::string_view pointer);

/// Pointer of the first field with this name in any section, except fields in items of lists.
std::optional<std::string_view> FindName(std::string_view name);

/// The known pointer that an unknown pointer may mean: a pointer with a similar spelling and the
/// same indices, or the pointer of a field with the same name in another section.
std::optional<std::string> SuggestPointer(std::string_view pointer);

}  // namespace fogline
