// ScenarioSchema: a visitor that writes the JSON schema (draft-07) of every field.
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "scenario/io/loader.h"

namespace fogline {
namespace {

using Json = nlohmann::ordered_json;

// Control characters: C0, DEL and C1. The schema uses this pattern under `not`: with a pattern that
// a whole text must match, `$` would accept a line feed at the end in some engines.
constexpr std::string_view kControlCharacter = R"([\u0000-\u001f\u007f-\u009f])";

// Integers without ".0", so that a person reads the bounds easily.
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

std::string Description(std::string_view doc, std::string_view source) {
  return source.empty() ? std::string(doc) : fmt::format("{} Source: {}.", doc, source);
}

Json TextSchema(std::string_view name, std::string_view doc) {
  return {{"type", "string"},
          {"title", name},
          {"description", doc},
          {"maxLength", kMaxTextLength},
          {"not", {{"pattern", kControlCharacter}}}};
}

template <class Spec>
Json NumberSchema(std::string_view type, std::string_view name, const Spec& spec) {
  return {{"type", type},
          {"title", Title(name, spec.unit)},
          {"description", Description(spec.doc, spec.source)},
          {"minimum", JsonNumber(static_cast<double>(spec.min))},
          {"maximum", JsonNumber(static_cast<double>(spec.max))}};
}

Json ListSchema(std::string_view name, std::string_view doc, const ListSpec& list, Json items) {
  return {{"type", "array"},
          {"title", name},
          {"description", doc},
          {"minItems", list.min_items},
          {"maxItems", list.max_items},
          {"items", std::move(items)},
          {"default", Json::array()}};
}

// Fills the `properties` of one object's schema.
class SchemaBuilder {
 public:
  explicit SchemaBuilder(Json& schema) : schema_(schema) {}

  void Number(std::string_view name, const double& value, const NumberSpec& spec) {
    Add(name, NumberSchema("number", name, spec), JsonNumber(value));
  }
  void Integer(std::string_view name, const std::int64_t& value, const IntegerSpec& spec) {
    Add(name, NumberSchema("integer", name, spec), value);
  }
  void Flag(std::string_view name, const bool& value, std::string_view doc) {
    Add(name, {{"type", "boolean"}, {"title", name}, {"description", doc}}, value);
  }
  void Text(std::string_view name, const std::string& value, std::string_view doc) {
    Add(name, TextSchema(name, doc), value);
  }
  template <class Enum>
  void Choice(std::string_view name, const Enum& value, std::string_view doc) {
    const std::span<const std::string_view> names = ChoiceNames<Enum>::kNames;
    const std::span<const std::string_view> docs = ChoiceNames<Enum>::kDocs;
    Add(name,
        {{"type", "string"},
         {"title", name},
         {"description", doc},
         {"enum", std::vector(names.begin(), names.end())},
         {"enumDescriptions", std::vector(docs.begin(), docs.end())}},
        names[static_cast<std::size_t>(value)]);
  }
  void Numbers(std::string_view name, const std::vector<double>&, const NumberSpec& spec,
               const ListSpec& list) {
    Property(name) = ListSchema(
        Title(name, spec.unit), Description(spec.doc, spec.source), list,
        {{"type", "number"}, {"minimum", JsonNumber(spec.min)}, {"maximum", JsonNumber(spec.max)}});
  }
  template <class T>
  void Section(std::string_view name, const T& section, std::string_view doc) {
    Property(name) = ObjectSchema(name, doc, section);
  }
  template <class T>
  void List(std::string_view name, const std::vector<T>&, const ListSpec& list) {
    Property(name) =
        ListSchema(name, list.doc, list, ObjectSchema("item", "An item of the list.", T{}));
  }
  void Needs(const NeedSpec& spec) {
    Json any_of = Json::array();
    for (const std::string_view field : spec.fields) {
      // minLength applies to texts only, and minItems to lists only.
      any_of.push_back(
          {{"required", {field}}, {"properties", {{field, {{"minLength", 1}, {"minItems", 1}}}}}});
    }
    schema_["if"] = {{"required", {spec.choice}},
                     {"properties", {{spec.choice, {{"const", spec.value}}}}}};
    schema_["then"] = {{"required", {spec.section}},
                       {"properties", {{spec.section, {{"anyOf", any_of}}}}}};
  }

  template <class T>
  static Json ObjectSchema(std::string_view title, std::string_view doc, const T& object) {
    Json schema{{"type", "object"},
                {"title", title},
                {"description", doc},
                {"additionalProperties", false},
                {"properties", Json::object()}};
    SchemaBuilder builder(schema);
    T::Fields(object, builder);
    return schema;
  }

 private:
  Json& Property(std::string_view name) { return schema_["properties"][std::string(name)]; }
  void Add(std::string_view name, Json property, Json default_value) {
    property["default"] = std::move(default_value);
    Property(name) = std::move(property);
  }

  Json& schema_;
};

}  // namespace

std::string ScenarioSchema() {
  const Json scenario =
      SchemaBuilder::ObjectSchema("Fogline scenario", "An experiment.", Scenario{});
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}};
  schema.update(scenario);
  schema["required"] = {"version"};
  Json& properties = schema["properties"];
  Json with_schema{
      {"$schema", TextSchema("$schema", "The JSON schema of this file, for editors.")}};
  with_schema.update(properties);
  properties = with_schema;
  return schema.dump(2) + "\n";
}

}  // namespace fogline
