// A set of LCM's message types in which every member's type is known.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "tools/web/types/lcm_struct.h"

namespace fogline::web {

class LcmTypes {
 public:
  /// Finds the structs of all members, and computes fingerprints and sizes.
  /// @throws InputError if a struct is missing, defined twice, or contains itself
  explicit LcmTypes(std::vector<LcmStruct> structs);

  std::span<const LcmStruct> structs() const { return structs_; }
  /// The struct with this name, without its package; nullptr if there is none.
  const LcmStruct* Named(std::string_view name) const;
  /// The struct with this fingerprint; nullptr if there is none.
  const LcmStruct* WithFingerprint(std::int64_t fingerprint) const;
  /// The type of a message, by its first 8 bytes; nullptr if it is unknown.
  const LcmStruct* TypeOf(Bytes message) const;
  /// The struct that is the type of a member. @pre the member is not a primitive
  const LcmStruct& StructOf(const LcmMember& member) const { return structs_[member.nested]; }
  /// Size of a member on the wire; nullopt if it varies, or no message has room for it.
  std::optional<std::size_t> FixedSize(const LcmMember& member) const;

 private:
  void Complete(std::size_t place, std::vector<int>& states);

  std::vector<LcmStruct> structs_;
};

/// Size of the fingerprint with which each message begins, in bytes.
inline constexpr std::size_t kFingerprintBytes = 8;

/// The types in the files of lcmtypes/. The program contains the texts of these files.
const LcmTypes& FoglineTypes();

}  // namespace fogline::web
