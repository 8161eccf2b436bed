// A struct of LCM's type language: the description of one message type in a file of lcmtypes/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace fogline::web {

using Bytes = std::span<const std::uint8_t>;

/// The primitive types of LCM.
enum class LcmPrimitive : std::uint8_t {
  kInt8,
  kInt16,
  kInt32,
  kInt64,
  kByte,
  kBoolean,
  kFloat,
  kDouble,
  kString,
};

/// The primitive type with this name; nullopt if it is the name of a struct.
std::optional<LcmPrimitive> PrimitiveNamed(std::string_view name);

/// Size of a value on the wire, in bytes. A string has no fixed size, and the result is 0.
std::size_t WireSize(LcmPrimitive primitive);

/// Whether a member of this type may be the length of an array.
bool MayBeLength(LcmPrimitive primitive);

struct LcmConstant {
  std::string name;
  std::string type;
  std::variant<std::int64_t, double> value;
  std::string comment;
};

/// One dimension of an array.
struct LcmDimension {
  std::string size;  // as written: a number, or the name of the member with the length
  std::optional<std::size_t> fixed;  // the number; nullopt if the length varies
  std::size_t slot =
      0;  // if the length varies: LcmMember::length_slot of the member with the length
};

struct LcmMember {
  std::string name;
  std::string type;                       // as written: a primitive type or a struct
  std::optional<LcmPrimitive> primitive;  // nullopt: a struct
  std::size_t nested = 0;                 // index of a struct in LcmTypes::structs()
  std::vector<LcmDimension> dimensions;   // empty: a single value
  std::string comment;                    // comments before and after the member
  /// The members of a struct that are lengths of arrays have the numbers 0, 1, 2 ... This is the
  /// number of this member; nullopt if the member is not the length of an array.
  std::optional<std::size_t> length_slot;
};

struct LcmStruct {
  std::string package;
  std::string name;
  std::string comment;
  std::vector<LcmConstant> constants;
  std::vector<LcmMember> members;
  /// The first 8 bytes of each message of this type. LcmTypes computes it.
  std::int64_t fingerprint = 0;
  /// Size on the wire without the fingerprint, in bytes; nullopt if the size varies. LcmTypes
  /// computes it.
  std::optional<std::size_t> fixed_size;

  std::string FullName() const { return package.empty() ? name : package + "." + name; }
};

/// Limits for the parser. With these limits, a decoder needs no allocated memory for lengths and
/// dimensions.
inline constexpr std::size_t kMaxLengths = 16;  // limit for a struct's members that are lengths
inline constexpr std::size_t kMaxDimensions = 4;

/// The hash of the struct's own names, types and dimensions, without the structs in it. LCM's
/// lcm-gen computes it in the same way (lcmgen.c, lcm_struct_hash).
std::int64_t OwnHash(const LcmStruct& type);

/// The unit at the end of a field's name, such as "m/s" for "host_speed_mps"; "" if the name has
/// none.
std::string_view UnitOf(std::string_view field);

}  // namespace fogline::web
