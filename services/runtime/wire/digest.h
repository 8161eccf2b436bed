// The digest of a run. Equal digests mean that two runs are equal bit by bit.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

/// Computes BLAKE2b-256 of bytes that come in pieces.
class Hash {
 public:
  Hash();
  ~Hash();
  Hash(Hash&&) noexcept;
  Hash& operator=(Hash&&) noexcept;

  void Add(Bytes piece);
  /// The hash of everything added so far, as 64 hexadecimal digits.
  std::string Hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Computes BLAKE2b-256 of the payloads of all channels with a message in each step (Pace::kStep),
/// step by step, and in the order of the graph table within a step. The run id is not included,
/// because the id names a run but does not describe the run.
class Digest {
 public:
  /// Adds one encoded message (at least kHeaderEnd bytes).
  void Add(Bytes message) {
    hash_.Add(message.first(kRunIdOffset));
    hash_.Add(message.subspan(kStepOffset));
  }

  /// The hash of everything added so far, as 64 hexadecimal digits.
  std::string Hex() const { return hash_.Hex(); }

 private:
  Hash hash_;
};

/// BLAKE2b-256 of a text, as 64 hexadecimal digits.
std::string HashOf(std::string_view text);

}  // namespace fogline::runtime
