// Reads one number from the bytes of a message, without decoding the rest of the message.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "tools/web/types/lcm_types.h"

namespace fogline::web {

/// For one field of one type. It is cheap to call on millions of messages: members of fixed size
/// are skipped together, and nothing is allocated. It may be used in several threads at once. The
/// types must outlive it.
class FieldReader {
 public:
  /// @param path such as "host_gap_m", "header.step", "follower_gap_m[0]", "covariance[0][2]"
  /// @throws InputError if the type has no such field, or if it is no number; the text proposes the
  ///     nearest name. An index in an array whose length varies may be any.
  FieldReader(const LcmTypes& types, const LcmStruct& type, std::string_view path);

  /// The value. A boolean is 0 or another number. An integer beyond 2^53 is rounded.
  /// @param message with its fingerprint; bytes behind the field do not matter, a signature neither
  /// @return nullopt if the message is of another type, ends before the field, has fewer elements,
  ///     or the value is infinite or NaN
  std::optional<double> operator()(Bytes message) const;

 private:
  /// Fixed bytes to skip, then a member whose size varies or that is a length. nullptr: no member.
  struct Stride {
    std::size_t bytes = 0;
    const LcmMember* member = nullptr;
  };
  /// The way through one struct.
  struct Level {
    std::vector<Stride> strides;        // over the members before `target`
    const LcmMember* target = nullptr;  // a struct, or a number on the last level
    std::vector<std::size_t> indices;   // one for each dimension of the target
  };

  const LcmTypes& types_;
  std::int64_t fingerprint_;
  std::vector<Level> levels_;
};

}  // namespace fogline::web
