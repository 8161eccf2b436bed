#include "tools/export/mcap/translate.h"

#include <cstddef>
#include <cstdint>
#include <optional>

#include "tools/export/mcap/descriptor.h"
#include "tools/export/mcap/protobuf.h"
#include "tools/web/types/wire_cursor.h"

namespace fogline::mcap {
namespace {

WireKind KindOf(FieldType type) {
  switch (type) {
    case FieldType::kDouble:
      return WireKind::kFixed64;
    case FieldType::kFloat:
      return WireKind::kFixed32;
    case FieldType::kString:
    case FieldType::kBytes:
    case FieldType::kMessage:
      return WireKind::kLength;
    default:
      return WireKind::kVarint;
  }
}

/// Translates one message. Each function returns false if the bytes are not a message of the type.
class Translator {
 public:
  Translator(const web::LcmTypes& types, web::Bytes message) : types_(types), cursor_(message) {}

  bool Message(const web::LcmStruct& type, std::string& to) {
    return cursor_.Integer(web::LcmPrimitive::kInt64) == type.fingerprint && Struct(type, to) &&
           cursor_.AtEnd();
  }

 private:
  bool Struct(const web::LcmStruct& type, std::string& to) {
    web::Lengths lengths{};
    std::uint32_t number = 0;
    for (const web::LcmMember& member : type.members) {
      if (!Member(member, ++number, lengths, to)) return false;
    }
    return true;
  }

  bool Member(const web::LcmMember& member, std::uint32_t number, web::Lengths& lengths,
              std::string& to) {
    if (member.length_slot) {
      const auto length = cursor_.Integer(*member.primitive);
      if (!length) return false;
      lengths[*member.length_slot] = *length;
      PutIntegerField(number, *length, to);
      return true;
    }
    const auto extent = cursor_.ExtentOf(member, lengths);
    if (!extent) return false;
    const WireKind kind = KindOf(FieldTypeOf(member));
    const bool is_number = kind != WireKind::kLength || IsBytes(member);
    if (is_number && member.dimensions.empty()) {
      PutTag(number, kind, to);
      return Number(*member.primitive, to);
    }
    if (is_number) return Packed(member, number, extent->count, to);
    for (std::size_t i = 0; i < extent->count; ++i) {
      if (!Element(member, number, to)) return false;
    }
    return true;
  }

  /// Appends several numbers as one field, without tags between the numbers. An array of bytes is
  /// also such a field.
  bool Packed(const web::LcmMember& member, std::uint32_t number, std::size_t count,
              std::string& to) {
    std::string numbers;
    for (std::size_t i = 0; i < count; ++i) {
      if (!(IsBytes(member) ? Byte(numbers) : Number(*member.primitive, numbers))) return false;
    }
    PutLengthField(number, numbers, to);
    return true;
  }

  /// Appends a string or a struct, with its tag.
  bool Element(const web::LcmMember& member, std::uint32_t number, std::string& to) {
    if (member.primitive) {
      const auto text = cursor_.Text();
      if (text) PutLengthField(number, *text, to);
      return text.has_value();
    }
    std::string nested;
    if (!Struct(types_.StructOf(member), nested)) return false;
    PutLengthField(number, nested, to);
    return true;
  }

  bool Number(web::LcmPrimitive primitive, std::string& to) {
    if (primitive == web::LcmPrimitive::kDouble || primitive == web::LcmPrimitive::kFloat) {
      const auto value = cursor_.Number(primitive);
      if (!value) return false;
      primitive == web::LcmPrimitive::kDouble
          ? web::PutLittleEndian(*value, to)
          : web::PutLittleEndian(static_cast<float>(*value), to);
      return true;
    }
    const auto value = cursor_.Integer(primitive);
    if (!value) return false;
    const bool boolean = primitive == web::LcmPrimitive::kBoolean;
    PutVarint(static_cast<std::uint64_t>(boolean ? *value != 0 : *value), to);
    return true;
  }

  bool Byte(std::string& to) {
    const auto value = cursor_.Integer(web::LcmPrimitive::kByte);
    if (value) to += static_cast<char>(*value);
    return value.has_value();
  }

  const web::LcmTypes& types_;
  web::WireCursor cursor_;
};

}  // namespace

bool AppendProtobuf(const web::LcmTypes& types, const web::LcmStruct& type, web::Bytes message,
                    std::string& to) {
  return Translator(types, message).Message(type, to);
}

}  // namespace fogline::mcap
