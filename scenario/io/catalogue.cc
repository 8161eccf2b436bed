#include "scenario/io/catalogue.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/text.h"

namespace fogline {
namespace {

// The segments of a pointer, each with the slash before it.
std::vector<std::string_view> Segments(std::string_view pointer) {
  std::vector<std::string_view> segments;
  while (!pointer.empty()) {
    segments.push_back(pointer.substr(0, pointer.find('/', 1)));
    pointer.remove_prefix(segments.back().size());
  }
  return segments;
}

bool IsIndex(std::string_view segment) { return !segment.empty() && ListIndex(segment.substr(1)); }

// `pointer` with * in place of each index.
std::string WithoutIndices(std::string_view pointer) {
  std::string out;
  for (const std::string_view segment : Segments(pointer)) out += IsIndex(segment) ? "/*" : segment;
  return out;
}

// `pattern`, in which the index of `pointer` at the same depth replaces each *.
std::string WithIndicesOf(std::string_view pointer, std::string_view pattern) {
  const std::vector<std::string_view> segments = Segments(pointer);
  std::string out;
  std::size_t depth = 0;
  for (const std::string_view segment : Segments(pattern)) {
    const bool index = segment == "/*" && depth < segments.size() && IsIndex(segments[depth]);
    out += index ? segments[depth] : segment;
    ++depth;
  }
  return out;
}

// All fields of `file`, in which each list gets one item. `file` must outlive the result.
template <class File>
FieldList CatalogueOf(File& file) {
  // An item of a list can contain lists, so each pass may add fields. The loop ends after a pass
  // that adds no field.
  for (std::size_t known = 0; known < AllFields(file).size();) {
    const FieldList fields = AllFields(file);
    known = fields.size();
    for (const Field& field : fields) {
      if (const auto* list = field.As<ListField>()) {
        if (list->items("").empty()) list->reset(1);
      }
      if (const auto* numbers = field.As<NumbersField>()) numbers->values->resize(1);
      if (const auto* texts = field.As<TextsField>()) texts->values->resize(1);
    }
  }
  FieldList fields = AllFields(file);
  for (Field& field : fields) field.pointer = WithoutIndices(field.pointer);
  return fields;
}

}  // namespace

const FieldList& Catalogue() {
  static Scenario scenario;
  static const FieldList catalogue = CatalogueOf(scenario);
  return catalogue;
}

const FieldList& ExperimentCatalogue() {
  static ExperimentPlan plan;
  static const FieldList catalogue = CatalogueOf(plan);
  return catalogue;
}

const FieldList& LabCatalogue() {
  static LabPlan plan;
  static const FieldList catalogue = CatalogueOf(plan);
  return catalogue;
}

const Field* FindField(std::string_view pointer) {
  static const Field root{
      .pointer = "/", .name = "", .doc = "A scenario.", .source = "", .value = SectionField{}};
  if (pointer.empty() || pointer == "/") return &root;
  const std::string wanted = WithoutIndices(pointer);
  const FieldList& catalogue = Catalogue();
  const auto it = std::find_if(catalogue.begin(), catalogue.end(),
                               [&](const Field& field) { return field.pointer == wanted; });
  return it == catalogue.end() ? nullptr : &*it;
}

std::string NearestKnownPointer(std::string_view pointer) {
  while (!pointer.empty() && FindField(pointer) == nullptr) {
    pointer = pointer.substr(0, std::min(pointer.rfind('/'), pointer.size() - 1));
  }
  return pointer.empty() ? "/" : std::string(pointer);
}

std::optional<std::string_view> FindName(std::string_view name) {
  for (const Field& field : Catalogue()) {
    const bool in_list = field.pointer.find('*') != std::string::npos;
    if (field.name == name && !in_list) return field.pointer;
  }
  return std::nullopt;
}

std::optional<std::string> SuggestPointer(std::string_view pointer) {
  std::vector<std::string_view> pointers{"/"};
  for (const Field& field : Catalogue()) pointers.emplace_back(field.pointer);
  if (const auto alike = Nearest(WithoutIndices(pointer), pointers)) {
    return WithIndicesOf(pointer, *alike);
  }
  const auto same = FindName(pointer.substr(pointer.rfind('/') + 1));
  return same ? std::optional<std::string>(*same) : std::nullopt;
}

}  // namespace fogline
