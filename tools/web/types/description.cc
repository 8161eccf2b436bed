#include "tools/web/types/description.h"

#include <tuple>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "services/graph.h"
#include "tools/web/types/decode.h"

namespace fogline::web {
namespace {

using Json = nlohmann::ordered_json;

Json ConstantJson(const LcmConstant& constant) {
  if (const auto* integer = std::get_if<std::int64_t>(&constant.value))
    return IntegerJson(*integer);
  return std::get<double>(constant.value);
}

Json MemberJson(const LcmMember& member) {
  Json json{{"name", member.name},
            {"type", member.type},
            {"dims", Json::array()},
            {"comment", member.comment},
            {"unit", UnitOf(member.name)}};
  for (const LcmDimension& dimension : member.dimensions) {
    json["dims"].push_back(dimension.fixed ? Json(*dimension.fixed) : Json(dimension.size));
  }
  return json;
}

Json TypeJson(const LcmStruct& type) {
  Json json{{"comment", type.comment}, {"constants", Json::object()}, {"members", Json::array()}};
  for (const LcmConstant& constant : type.constants) {
    json["constants"][constant.name] = ConstantJson(constant);
  }
  for (const LcmMember& member : type.members) json["members"].push_back(MemberJson(member));
  return json;
}

Json StructSchema(const LcmTypes& types, const LcmStruct& type);

/// The schema of one element of a member.
Json ElementSchema(const LcmTypes& types, const LcmMember& member) {
  if (!member.primitive) return StructSchema(types, types.StructOf(member));
  switch (*member.primitive) {
    case LcmPrimitive::kString:
      return {{"type", "string"}};
    case LcmPrimitive::kBoolean:
      return {{"type", "boolean"}};
    case LcmPrimitive::kFloat:
    case LcmPrimitive::kDouble:
      return {{"type", "number"}};
    default:
      return {{"type", "integer"}};
  }
}

Json StructSchema(const LcmTypes& types, const LcmStruct& type) {
  Json schema{{"type", "object"}, {"properties", Json::object()}, {"required", Json::array()}};
  for (const LcmMember& member : type.members) {
    Json property = ElementSchema(types, member);
    for (std::size_t i = 0; i < member.dimensions.size(); ++i) {
      property = {{"type", "array"}, {"items", std::move(property)}};
    }
    std::string description = member.comment;
    if (const std::string_view unit = UnitOf(member.name); !unit.empty()) {
      description += fmt::format("{}[{}]", description.empty() ? "" : " ", unit);
    }
    if (!description.empty()) property["description"] = description;
    schema["properties"][member.name] = std::move(property);
    schema["required"].push_back(member.name);
  }
  return schema;
}

}  // namespace

Json TypesJson(const LcmTypes& types) {
  Json json = Json::object();
  for (const LcmStruct& type : types.structs()) json[type.name] = TypeJson(type);
  return json;
}

Json FingerprintsJson(const LcmTypes& types) {
  Json json = Json::object();
  for (const LcmStruct& type : types.structs()) {
    json[type.name] = fmt::format("0x{:016x}", static_cast<std::uint64_t>(type.fingerprint));
  }
  return json;
}

Json ChannelsJson() {
  Json json = Json::array();
  std::apply(
      [&json]<class... M>(const Channel<M>&... channel) {
        const auto add = [&json](const auto& info, std::string_view type) {
          const bool everyone = info.name == "STATUS" || info.name == "RESEND";
          json.push_back({{"id", json.size()},
                          {"name", info.name},
                          {"type", type},
                          {"from", everyone ? "everyone" : NameOf(info.from)},
                          {"what", info.what}});
        };
        (add(channel, M::getTypeName()), ...);
      },
      kGraph);
  return json;
}

Json SchemaJson(const LcmTypes& types, const LcmStruct& type) {
  Json schema = StructSchema(types, type);
  schema["title"] = type.FullName();
  if (!type.comment.empty()) schema["description"] = type.comment;
  return schema;
}

}  // namespace fogline::web
