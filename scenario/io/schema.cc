// ScenarioSchema: writes the JSON schema (draft-07) of every field.
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "scenario/io/catalogue.h"
#include "scenario/io/loader.h"

namespace fogline {
namespace {

using Json = nlohmann::ordered_json;

// Control characters: C0, DEL and C1. The schema uses this pattern under `not`. A pattern that a
// whole text must match would need `$`, which in some engines also accepts a line feed at the end.
constexpr std::string_view kControlCharacter = R"([\u0000-\u001f\u007f-\u009f])";

// Whole numbers are written without ".0", so that a person reads the bounds easily.
Json JsonNumber(double value) {
  constexpr double kExact = 0x1p53;
  if (std::trunc(value) == value && std::abs(value) < kExact) {
    return static_cast<std::int64_t>(value);
  }
  return value;
}

std::string Title(std::string_view name, std::string_view unit) {
  return unit.empty() ? std::string(name) : fmt::format("{} [{}]", name, unit);
}

std::string Description(const Field& field) {
  return fmt::format("{} Source: {}.", field.doc, field.source);
}

Json TextSchema(std::string_view name, std::string_view doc) {
  return {{"type", "string"},
          {"title", name},
          {"description", doc},
          {"maxLength", kMaxTextLength},
          {"not", {{"pattern", kControlCharacter}}}};
}

template <class Spec>
Json NumberSchema(std::string_view type, const Field& field, const Spec& spec) {
  return {{"type", type},
          {"title", Title(field.name, spec.unit)},
          {"description", Description(field)},
          {"minimum", JsonNumber(static_cast<double>(spec.min))},
          {"maximum", JsonNumber(static_cast<double>(spec.max))}};
}

Json ListSchema(std::string_view title, std::string_view doc, const ListSpec& list) {
  return {{"type", "array"},
          {"title", title},
          {"description", doc},
          {"minItems", list.min_items},
          {"maxItems", list.max_items},
          {"items", nullptr},
          {"default", Json::array()}};
}

Json ObjectSchema(std::string_view title, std::string_view doc) {
  return {{"type", "object"},
          {"title", title},
          {"description", doc},
          {"additionalProperties", false},
          {"properties", Json::object()}};
}

Json WithDefault(Json schema, Json default_value) {
  schema["default"] = std::move(default_value);
  return schema;
}

// The schema of a field, without the contents of a section or list.
struct FieldSchema {
  const Field& field;

  Json operator()(const NumberField& number) const {
    if (field.name.empty()) {
      return {{"type", "number"},
              {"minimum", JsonNumber(number.spec.min)},
              {"maximum", JsonNumber(number.spec.max)}};
    }
    return WithDefault(NumberSchema("number", field, number.spec), JsonNumber(*number.value));
  }
  Json operator()(const IntegerField& integer) const {
    return WithDefault(NumberSchema("integer", field, integer.spec), *integer.value);
  }
  Json operator()(const bool* flag) const {
    return {
        {"type", "boolean"}, {"title", field.name}, {"description", field.doc}, {"default", *flag}};
  }
  Json operator()(const std::string* text) const {
    return WithDefault(TextSchema(field.name, field.doc), *text);
  }
  Json operator()(const ChoiceField& choice) const {
    return {{"type", "string"},
            {"title", field.name},
            {"description", field.doc},
            {"enum", std::vector(choice.names.begin(), choice.names.end())},
            {"enumDescriptions", std::vector(choice.docs.begin(), choice.docs.end())},
            {"default", choice.names[choice.get()]}};
  }
  Json operator()(const NumbersField& numbers) const {
    return ListSchema(Title(field.name, numbers.spec.unit), Description(field), numbers.list);
  }
  Json operator()(const TextsField& texts) const {
    return ListSchema(field.name, field.doc, texts.list);
  }
  Json operator()(const ListField& list) const {
    return ListSchema(field.name, field.doc, list.list);
  }
  Json operator()(const SectionField&) const {
    return ObjectSchema(field.name.empty() ? "item" : field.name, field.doc);
  }
};

// The path of a field's schema within the schema of its file.
Json::json_pointer PlaceOf(std::string_view pointer) {
  std::string place;
  while (!pointer.empty()) {
    const std::string_view segment = pointer.substr(0, pointer.find('/', 1));
    place += segment == "/*" ? "/items" : fmt::format("/properties{}", segment);
    pointer.remove_prefix(segment.size());
  }
  return Json::json_pointer(place);
}

// Adds a rule to the schema of `object`, which contains the section. The rule says: if the field
// need.choice has the value need.value, the section is required, and at least one of its fields
// need.fields must have contents.
void AddNeed(Json& object, std::string_view section, const NeedSpec& need) {
  Json any_of = Json::array();
  for (const std::string_view field : need.fields) {
    // JSON schema applies minLength only to texts, and minItems only to lists. So both keywords are
    // given here, and only the keyword for the field's type has an effect.
    any_of.push_back(
        {{"required", {field}}, {"properties", {{field, {{"minLength", 1}, {"minItems", 1}}}}}});
  }
  const Json chosen{{"required", {need.choice}},
                    {"properties", {{need.choice, {{"const", need.value}}}}}};
  const Json given{{"required", {section}}, {"properties", {{section, {{"anyOf", any_of}}}}}};
  object["allOf"].push_back({{"if", chosen}, {"then", given}});
}

/// The schema of a file.
/// @param all every field, section and list of the file; see Catalogue()
std::string SchemaOf(std::string_view title, std::string_view doc, const FieldList& all) {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}};
  schema.update(ObjectSchema(title, doc));
  schema["properties"]["$schema"] =
      TextSchema("$schema", "The JSON schema of this file, for editors.");
  for (const Field& field : all) {
    const bool is_text_of_list = field.name.empty() && field.As<std::string*>() != nullptr;
    schema[PlaceOf(field.pointer)] = is_text_of_list ? TextSchema("item", field.doc)
                                                     : std::visit(FieldSchema{field}, field.value);
    const auto* section = field.As<SectionField>();
    if (section == nullptr || section->need.choice.empty()) continue;
    const std::string outer = field.pointer.substr(0, field.pointer.rfind('/'));
    AddNeed(schema[PlaceOf(outer)], field.name, section->need);
  }
  schema["required"] = {"version"};
  return schema.dump(2) + "\n";
}

}  // namespace

std::string ScenarioSchema() { return SchemaOf("Fogline scenario", "An experiment.", Catalogue()); }

std::string ExperimentSchema() {
  return SchemaOf("Fogline experiment", "An experiment with people.", ExperimentCatalogue());
}

std::string LabSchema() {
  return SchemaOf("Fogline laboratory", "The machines of a laboratory.", LabCatalogue());
}

}  // namespace fogline
