// Finds the fields of a scenario by their JSON pointers, for explanations, overrides and
// suggestions.
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

/// Finds the field with this pointer, or returns null. Every index in the pointer, such as 7,
/// stands for the one item that the list has in Catalogue(). "/" and "" find the whole scenario,
/// which is not in Catalogue().
const Field* FindField(std::string_view pointer);

/// The longest beginning of `pointer` that names a field or a section; "/" if no beginning does.
std::string NearestKnownPointer(std::string_view pointer);

/// The pointer of the first field with this name, in any section; nothing if there is no such
/// field. Fields in items of lists are left out.
std::optional<std::string_view> FindName(std::string_view name);

/// The known pointer that an unknown pointer may mean: a pointer with a similar spelling and the
/// same indices, or the pointer of a field with the same name in another section.
std::optional<std::string> SuggestPointer(std::string_view pointer);

}  // namespace fogline
