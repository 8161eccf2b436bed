// Describes a message type of lcmtypes/ as a message type of Protocol Buffers:
//
//     lcmtypes                           | protobuf (proto3)
//     -----------------------------------|-------------------------------------------------------
//     struct fogline.truth_t             | message fogline.truth_t
//     member                             | field of the same name; numbered in order from 1
//     int8_t, int16_t, int32_t; int64_t  | int32; int64
//     byte; boolean                      | uint32; bool
//     float; double; string              | float; double; string
//     array of byte                      | bytes
//     another array, with any dimensions | repeated; a matrix row by row
#pragma once

#include <cstdint>
#include <string>

#include "tools/web/types/lcm_types.h"

namespace fogline::mcap {

/// Values of FieldDescriptorProto.Type (google/protobuf/descriptor.proto).
enum class FieldType : std::uint8_t {
  kDouble = 1,
  kFloat = 2,
  kInt64 = 3,
  kInt32 = 5,
  kBool = 8,
  kString = 9,
  kMessage = 11,
  kBytes = 12,
  kUint32 = 13,
};

/// Whether a member is an array of LCM's type `byte`. Such a member becomes one value of the type
/// `bytes`.
bool IsBytes(const web::LcmMember& member);
FieldType FieldTypeOf(const web::LcmMember& member);

/// A serialised google.protobuf.FileDescriptorSet with one file: the types of the members, and then
/// the type itself. So the set needs no other file.
std::string DescriptorSetOf(const web::LcmTypes& types, const web::LcmStruct& type);

}  // namespace fogline::mcap
