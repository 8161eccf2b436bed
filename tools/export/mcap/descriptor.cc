#include "tools/export/mcap/descriptor.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <fmt/core.h>

#include "tools/export/mcap/protobuf.h"

namespace fogline::mcap {
namespace {

// The numbers of fields in google/protobuf/descriptor.proto.
namespace file_descriptor_set {
constexpr std::uint32_t kFile = 1;
}
namespace file_descriptor {
constexpr std::uint32_t kName = 1;
constexpr std::uint32_t kPackage = 2;
constexpr std::uint32_t kMessageType = 4;
constexpr std::uint32_t kSyntax = 12;
}  // namespace file_descriptor
namespace descriptor {
constexpr std::uint32_t kName = 1;
constexpr std::uint32_t kField = 2;
}  // namespace descriptor
namespace field_descriptor {
constexpr std::uint32_t kName = 1;
constexpr std::uint32_t kNumber = 3;
constexpr std::uint32_t kLabel = 4;
constexpr std::uint32_t kType = 5;
constexpr std::uint32_t kTypeName = 6;
constexpr std::int64_t kLabelOptional = 1;
constexpr std::int64_t kLabelRepeated = 3;
}  // namespace field_descriptor

std::string FieldDescriptor(const web::LcmTypes& types, const web::LcmMember& member,
                            std::size_t number) {
  const bool repeated = !member.dimensions.empty() && !IsBytes(member);
  std::string text;
  PutLengthField(field_descriptor::kName, member.name, text);
  PutIntegerField(field_descriptor::kNumber, static_cast<std::int64_t>(number), text);
  PutIntegerField(field_descriptor::kLabel,
                  repeated ? field_descriptor::kLabelRepeated : field_descriptor::kLabelOptional,
                  text);
  PutIntegerField(field_descriptor::kType, static_cast<std::int64_t>(FieldTypeOf(member)), text);
  if (!member.primitive) {
    PutLengthField(field_descriptor::kTypeName, "." + types.StructOf(member).FullName(), text);
  }
  return text;
}

std::string Descriptor(const web::LcmTypes& types, const web::LcmStruct& type) {
  std::string text;
  PutLengthField(descriptor::kName, type.name, text);
  for (std::size_t i = 0; i < type.members.size(); ++i) {
    PutLengthField(descriptor::kField, FieldDescriptor(types, type.members[i], i + 1), text);
  }
  return text;
}

/// Adds to `collected` the structs of all members, then the struct itself.
void Collect(const web::LcmTypes& types, const web::LcmStruct& type,
             std::vector<const web::LcmStruct*>& collected) {
  if (std::ranges::find(collected, &type) != collected.end()) return;
  for (const web::LcmMember& member : type.members) {
    if (!member.primitive) Collect(types, types.StructOf(member), collected);
  }
  collected.push_back(&type);
}

}  // namespace

bool IsBytes(const web::LcmMember& member) {
  return member.primitive == web::LcmPrimitive::kByte && !member.dimensions.empty();
}

FieldType FieldTypeOf(const web::LcmMember& member) {
  if (!member.primitive) return FieldType::kMessage;
  switch (*member.primitive) {
    case web::LcmPrimitive::kInt64:
      return FieldType::kInt64;
    case web::LcmPrimitive::kByte:
      return member.dimensions.empty() ? FieldType::kUint32 : FieldType::kBytes;
    case web::LcmPrimitive::kBoolean:
      return FieldType::kBool;
    case web::LcmPrimitive::kFloat:
      return FieldType::kFloat;
    case web::LcmPrimitive::kDouble:
      return FieldType::kDouble;
    case web::LcmPrimitive::kString:
      return FieldType::kString;
    default:
      return FieldType::kInt32;
  }
}

std::string DescriptorSetOf(const web::LcmTypes& types, const web::LcmStruct& type) {
  std::string file;
  PutLengthField(file_descriptor::kName, fmt::format("{}.proto", type.FullName()), file);
  PutLengthField(file_descriptor::kPackage, type.package, file);
  std::vector<const web::LcmStruct*> messages;
  Collect(types, type, messages);
  for (const web::LcmStruct* message : messages) {
    PutLengthField(file_descriptor::kMessageType, Descriptor(types, *message), file);
  }
  PutLengthField(file_descriptor::kSyntax, "proto3", file);
  std::string set;
  PutLengthField(file_descriptor_set::kFile, file, set);
  return set;
}

}  // namespace fogline::mcap
