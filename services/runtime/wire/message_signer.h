// Signs messages, and verifies signed messages. A trailer after the LCM payload proves that the
// sender has the key. LCM's generated decoders ignore the bytes after a payload, so lcm-spy,
// lcm-logger and lcm-logplayer still work.
//
//   payload | "FLS1" | key id, 2 bytes | sender's role, 2 bytes | tag, 16 bytes
//
// The tag is the keyed BLAKE2b hash (RFC 7693) of the channel's name, a zero byte, the sender and
// the payload. The payload's own header contains run id and step. So a message is not valid in
// another run, in another step, on another channel or from another role. All processes share one
// key: a process that has the key can sign as any role. The key id distinguishes keys and protects
// nothing.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/graph.h"
#include "services/runtime/wire/wire.h"

namespace fogline::runtime {

/// 32 secret bytes. A key file contains these bytes as 64 hexadecimal digits. A line end may
/// follow.
class SigningKey {
 public:
  using Secret = std::array<std::uint8_t, 32>;

  explicit SigningKey(const Secret& secret) : secret_(secret) {}
  ~SigningKey();
  SigningKey(const SigningKey&) = default;
  SigningKey& operator=(const SigningKey&) = default;

  /// @throws InputError when the file cannot be read, contains no key, or is not a secret of this
  ///     user. A file is not a secret if it belongs to another user (except root), or if other
  ///     users can read or change it.
  static SigningKey Load(const std::filesystem::path& file);
  /// Writes a random key into a new file that only its owner can read.
  /// @throws InputError when the file exists or cannot be created; std::runtime_error when the key
  ///     cannot be written, for example because the disk is full
  static void Create(const std::filesystem::path& file);

  const Secret& secret() const { return secret_; }

 private:
  Secret secret_;
};

/// Size of the trailer in bytes.
inline constexpr std::size_t kSignatureBytes = 24;

inline constexpr std::array<std::uint8_t, 4> kSignatureMagic{'F', 'L', 'S', '1'};

/// Whether the message ends like a signed message. The signature is not verified.
inline bool LooksSigned(Bytes message) {
  return message.size() >= kSignatureBytes &&
         std::memcmp(message.data() + message.size() - kSignatureBytes, kSignatureMagic.data(),
                     kSignatureMagic.size()) == 0;
}
/// The message without its last kSignatureBytes. @pre LooksSigned(message)
inline Bytes WithoutSignature(Bytes message) {
  return message.first(message.size() - kSignatureBytes);
}

/// Signs and verifies the messages of one process.
class MessageSigner {
 public:
  /// @param sender this process's role; nullopt if the process has every role (a run in memory).
  ///     With nullopt, each message is signed as its producer would sign it.
  MessageSigner(const SigningKey& key, std::optional<Role> sender)
      : key_(key), id_(IdOf(key)), sender_(sender) {}

  /// The payload with its trailer; valid until the next call.
  Bytes Sign(std::string_view channel, Bytes payload);

  enum class Verdict {
    kGood,
    kNotSigned,    // without a trailer
    kBadlySigned,  // another key, altered bytes, or a sender without the right to send the message
  };
  struct Opened {
    Verdict verdict;
    Bytes payload;  // without the trailer; empty if the verdict is not good
  };
  Opened Open(std::string_view channel, Bytes message) const;

 private:
  using KeyId = std::array<std::uint8_t, 2>;
  using Sender = std::array<std::uint8_t, 2>;
  using Tag = std::array<std::uint8_t, 16>;
  static KeyId IdOf(const SigningKey& key);
  Tag TagOf(std::string_view channel, const Sender& sender, Bytes payload) const;

  SigningKey key_;
  KeyId id_;
  std::optional<Role> sender_;
  std::vector<std::uint8_t> message_;  // the last signed message
};

}  // namespace fogline::runtime
