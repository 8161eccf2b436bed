// ExplainField: the text about one field, or about the fields of a section, from the catalogue.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "scenario/io/loader.h"
#include "scenario/sections/field_text.h"

namespace fogline {
namespace {

// The values that a field allows.
struct AllowedValues {
  std::string operator()(const NumberField& number) const { return Allowed(number.spec); }
  std::string operator()(const IntegerField& integer) const { return Allowed(integer.spec); }
  std::string operator()(const bool*) const { return "true or false"; }
  std::string operator()(const std::string*) const { return AllowedText(); }
  std::string operator()(const ChoiceField& choice) const { return Names(choice.names); }
  std::string operator()(const NumbersField& numbers) const {
    return fmt::format("a list of {} numbers", Range(numbers.list));
  }
  std::string operator()(const TextsField& texts) const {
    return fmt::format("a list of {} texts", Range(texts.list));
  }
  std::string operator()(const ListField& list) const {
    return fmt::format("a list of {} objects", Range(list.list));
  }
  std::string operator()(const SectionField&) const { return "an object"; }
};

// The default of a field with its unit; "" for a section.
struct DefaultText {
  std::string operator()(const NumberField& number) const {
    return WithUnit(NumberText(*number.value), number.spec.unit);
  }
  std::string operator()(const IntegerField& integer) const {
    return WithUnit(std::to_string(*integer.value), integer.spec.unit);
  }
  std::string operator()(const bool* flag) const { return *flag ? "true" : "false"; }
  std::string operator()(const std::string* text) const { return Quote(*text); }
  std::string operator()(const ChoiceField& choice) const {
    return Quote(choice.names[choice.get()]);
  }
  std::string operator()(const NumbersField&) const { return "[]"; }
  std::string operator()(const TextsField&) const { return "[]"; }
  std::string operator()(const ListField&) const { return "[]"; }
  std::string operator()(const SectionField&) const { return ""; }
};

std::string DefaultOf(const Field& field) {
  return field.name.empty() ? "" : std::visit(DefaultText(), field.value);
}

std::string Meaning(const Field& field) {
  std::string meaning(field.doc);
  const auto* section = field.As<SectionField>();
  if (section == nullptr || section->need.choice.empty()) return meaning;
  const NeedSpec& need = section->need;
  return meaning + fmt::format(" If {} is {}, this section is required, with {} or {}.",
                               need.choice, Quote(need.value), need.fields[0], need.fields[1]);
}

void AddLine(std::string& text, std::string_view label, std::string_view content) {
  if (!content.empty()) text += fmt::format("  {:<9}{}\n", label, content);
}

// Whether `inner` lies directly in `outer`, such as /fog/model in /fog.
bool IsChild(std::string_view inner, std::string_view outer) {
  if (outer == "/") outer = "";
  return inner.size() > outer.size() + 1 && inner.starts_with(outer) &&
         inner[outer.size()] == '/' && inner.find('/', outer.size() + 1) == std::string_view::npos;
}

void AddChoices(std::string& text, const Field& field) {
  const auto* choice = field.As<ChoiceField>();
  for (std::size_t i = 0; choice != nullptr && i < choice->names.size(); ++i) {
    text += fmt::format("    {:<18}{}\n", Quote(choice->names[i]), choice->docs[i]);
  }
}

void AddChildren(std::string& text, const Field& section) {
  std::size_t width = 0;
  for (const Field& field : Catalogue()) {
    if (IsChild(field.pointer, section.pointer)) width = std::max(width, field.pointer.size());
  }
  if (width == 0) return;
  text += "  Fields:\n";
  for (const Field& field : Catalogue()) {
    if (!IsChild(field.pointer, section.pointer)) continue;
    std::string content = field.As<SectionField>() != nullptr
                              ? Meaning(field)
                              : std::visit(AllowedValues(), field.value);
    const std::string default_text = DefaultOf(field);
    if (!default_text.empty()) content += ", default " + default_text;
    text += fmt::format("    {:<{}}  {}\n", field.pointer, width, content);
  }
}

}  // namespace

std::string ExplainField(std::string_view pointer) {
  const Field* field = FindField(pointer);
  if (field == nullptr) {
    throw InputError(fmt::format("error: {}: no such field{}", Shown(pointer),
                                 DidYouMean(SuggestPointer(pointer))));
  }
  std::string text = field->pointer + "\n";
  AddLine(text, "Meaning:", Meaning(*field));
  if (field->As<SectionField>() == nullptr) {
    AddLine(text, "Allowed:", std::visit(AllowedValues(), field->value));
  }
  AddChoices(text, *field);
  AddLine(text, "Default:", DefaultOf(*field));
  AddLine(text, "Source:", field->source);
  AddChildren(text, *field);
  return text;
}

}  // namespace fogline
