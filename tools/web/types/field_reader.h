// Reads one number from the bytes of a message, without decoding the other fields.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "tools/web/types/lcm_types.h"

namespace fogline::web {

/// Reads one field of one type. Reading is cheap even for millions of messages: members of fixed
/// size are skipped together, and no memory is allocated. Several threads may use a reader at the
/// same time. The types must outlive the reader.
class FieldReader {
 public:
  /// @param path such as "host_gap_m", "header.step", "follower_gap_m[0]", "covariance[0][2]"
  /// @throws InputError if the type has no such field, or if the field is not a number; the text
  ///     proposes the nearest name. Any index is accepted for an array whose length varies.
  FieldReader(const LcmTypes& types, const LcmStruct& type, std::string_view path);

  /// Returns the value. A boolean is 0 (false) or another number (true). An integer beyond 2^53 is
  /// rounded.
  /// @param message with its fingerprint; bytes after the field, such as a signature, are ignored
  /// @return nullopt if the message is of another type, ends before the field, has fewer elements,
  ///     or the value is infinite or NaN
  std::optional<double> operator()(Bytes message) const;

 private:
  /// One step of the cursor: it skips `bytes` bytes, which belong to members of fixed size, and
  /// then `member`. The size of `member` varies, or `member` is a length. If only the bytes are
  /// skipped, `member` is nullptr.
  struct Stride {
    std::size_t bytes = 0;
    const LcmMember* member = nullptr;
  };
  /// The path through one struct.
  struct Level {
    std::vector<Stride> strides;        // steps over the members before `target`
    const LcmMember* target = nullptr;  // a struct; a number on the last level
    std::vector<std::size_t> indices;   // one for each dimension of the target
  };

  const LcmTypes& types_;
  std::int64_t fingerprint_;
  std::vector<Level> levels_;
};

}  // namespace fogline::web
