#include "tools/web/types/decode.h"

#include <cmath>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "common/text.h"
#include "tools/web/types/wire_cursor.h"

namespace fogline::web {
namespace {

using Json = nlohmann::ordered_json;

// The largest number up to which a double represents every integer.
constexpr std::int64_t kExact = std::int64_t{1} << 53;

Json TextJson(std::string_view text) {
  if (IsUtf8(text)) return text;
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
}

class Decoder {
 public:
  Decoder(const LcmTypes& types, Bytes message) : types_(types), cursor_(message) {}

  std::optional<Json> Message(const LcmStruct& type) {
    if (cursor_.Integer(LcmPrimitive::kInt64) != type.fingerprint) return std::nullopt;
    std::optional<Json> json = Struct(type);
    return cursor_.AtEnd() ? json : std::nullopt;
  }

 private:
  std::optional<Json> Struct(const LcmStruct& type) {
    Json json = Json::object();
    auto& members = json.get_ref<Json::object_t&>();
    members.reserve(type.members.size());
    Lengths lengths{};
    for (const LcmMember& member : type.members) {
      std::optional<Json> value = Member(member, lengths);
      if (!value) return std::nullopt;
      // No two members have the same name, so this code appends without a search for the name.
      members.emplace_back(member.name, std::move(*value));
    }
    return json;
  }

  std::optional<Json> Member(const LcmMember& member, Lengths& lengths) {
    if (member.length_slot) {
      const auto length = cursor_.Integer(*member.primitive);
      if (!length) return std::nullopt;
      lengths[*member.length_slot] = *length;
      return IntegerJson(*length);
    }
    const auto extent = cursor_.ExtentOf(member, lengths);
    if (!extent) return std::nullopt;
    if (extent->count == 0) return Json::array();
    return Array(member, *extent, 0);
  }

  std::optional<Json> Array(const LcmMember& member, const Extent& extent, std::size_t dimension) {
    if (dimension == member.dimensions.size()) return Element(member);
    Json array = Json::array();
    array.get_ref<Json::array_t&>().reserve(extent.sizes[dimension]);
    for (std::size_t i = 0; i < extent.sizes[dimension]; ++i) {
      std::optional<Json> element = Array(member, extent, dimension + 1);
      if (!element) return std::nullopt;
      array.push_back(std::move(*element));
    }
    return array;
  }

  std::optional<Json> Element(const LcmMember& member) {
    if (!member.primitive) return Struct(types_.StructOf(member));
    switch (*member.primitive) {
      case LcmPrimitive::kString: {
        const auto text = cursor_.Text();
        return text ? std::optional(TextJson(*text)) : std::nullopt;
      }
      case LcmPrimitive::kFloat:
      case LcmPrimitive::kDouble: {
        const auto value = cursor_.Number(*member.primitive);
        if (!value) return std::nullopt;
        return std::isfinite(*value) ? Json(*value) : Json(nullptr);
      }
      case LcmPrimitive::kBoolean: {
        const auto value = cursor_.Integer(*member.primitive);
        return value ? std::optional<Json>(*value != 0) : std::nullopt;
      }
      default: {
        const auto value = cursor_.Integer(*member.primitive);
        return value ? std::optional(IntegerJson(*value)) : std::nullopt;
      }
    }
  }

  const LcmTypes& types_;
  WireCursor cursor_;
};

}  // namespace

Json IntegerJson(std::int64_t value) {
  if (value > kExact || value < -kExact) return std::to_string(value);
  return value;
}

std::optional<Json> DecodeJson(const LcmTypes& types, const LcmStruct& type, Bytes message) {
  return Decoder(types, message).Message(type);
}

}  // namespace fogline::web
