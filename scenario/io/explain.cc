// ExplainField: what the catalogue knows about one field, or about the fields of a section.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "scenario/io/loader.h"

namespace fogline {
namespace {

void AddLine(std::string& text, std::string_view label, std::string_view content) {
  if (!content.empty()) text += fmt::format("  {:<9}{}\n", label, content);
}

// Whether `inner` lies directly in `outer`, such as /fog/model in /fog.
bool IsChild(std::string_view inner, std::string_view outer) {
  if (outer == "/") outer = "";
  return inner.size() > outer.size() + 1 && inner.starts_with(outer) &&
         inner[outer.size()] == '/' && inner.find('/', outer.size() + 1) == std::string_view::npos;
}

void AddChoices(std::string& text, const FieldInfo& info) {
  for (std::size_t i = 0; i < info.choices.size(); ++i) {
    text += fmt::format("    {:<18}{}\n", Quote(info.choices[i]), info.choice_docs[i]);
  }
}

void AddChildren(std::string& text, const FieldInfo& section) {
  std::size_t width = 0;
  for (const FieldInfo& info : Catalogue()) {
    if (IsChild(info.pointer, section.pointer)) width = std::max(width, info.pointer.size());
  }
  if (width == 0) return;
  text += "  Fields:\n";
  for (const FieldInfo& info : Catalogue()) {
    if (!IsChild(info.pointer, section.pointer)) continue;
    std::string content = info.is_section ? info.doc : info.allowed;
    if (!info.default_text.empty()) content += ", default " + info.default_text;
    text += fmt::format("    {:<{}}  {}\n", info.pointer, width, content);
  }
}

}  // namespace

std::string ExplainField(std::string_view pointer) {
  const FieldInfo* info = FindField(pointer);
  if (info == nullptr) {
    throw InputError(fmt::format("error: {}: no such field{}", Shown(pointer),
                                 DidYouMean(SuggestPointer(pointer))));
  }
  std::string text = info->pointer + "\n";
  AddLine(text, "Meaning:", info->doc);
  if (!info->is_section) AddLine(text, "Allowed:", info->allowed);
  AddChoices(text, *info);
  AddLine(text, "Default:", info->default_text);
  AddLine(text, "Source:", info->source);
  AddChildren(text, *info);
  return text;
}

}  // namespace fogline
