#include "services/runtime/wire/message_signer.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/file.h"
#include "common/text.h"

namespace fogline::runtime {
namespace {

constexpr std::size_t kKeyIdOffset = kSignatureMagic.size();
constexpr std::size_t kSenderOffset = kKeyIdOffset + 2;
constexpr std::size_t kTagOffset = kSenderOffset + 2;

/// The role that a STATUS names as its sender. This name is the first field after the header. LCM
/// encodes the name as an int32 length, which includes the final 0, and then the characters.
std::string_view RoleNamedIn(Bytes status) {
  constexpr std::size_t kLengthBytes = 4;
  constexpr std::size_t kText = kHeaderEnd + kLengthBytes;
  if (status.size() < kText) return "";
  std::size_t length = 0;
  for (const std::uint8_t byte : status.subspan(kHeaderEnd, kLengthBytes)) {
    length = (length << 8) | byte;
  }
  if (length < 1 || length > status.size() - kText) return "";
  return {reinterpret_cast<const char*>(status.data() + kText), length - 1};
}

/// The role that should have sent this message; nullopt if every role may send it.
std::optional<Role> ProducerOf(std::string_view channel, Bytes payload) {
  if (channel == ChannelOf<status_t>().name) {
    const std::string_view name = RoleNamedIn(payload);
    for (const RoleInfo& info : kRoles) {
      if (info.name == name) return info.role;
    }
    return Role::kRunner;  // unknown role: allows only the runner, which sends no STATUS
  }
  if (channel == ChannelOf<resend_t>().name) return std::nullopt;
  const auto* found = std::ranges::find(kChannels, channel, &ChannelInfo::name);
  if (found == kChannels.end()) return std::nullopt;
  return found->from;
}

/// Whether a role may send this message. A role may send its own messages. The recorder may also
/// send steps of other roles, because it answers requests for steps that their producers do not
/// store any more.
bool MaySend(Role sender, std::string_view channel, Bytes payload) {
  const auto* found = std::ranges::find(kChannels, channel, &ChannelInfo::name);
  const bool step = found != kChannels.end() && found->pace == Pace::kStep;
  return ProducerOf(channel, payload).value_or(sender) == sender ||
         (step && sender == Role::kRecorder);
}

InputError KeyError(const std::filesystem::path& file, const std::string& what) {
  return InputError(fmt::format("{}: error: {}", PathText(file), what));
}

void StartSodium() {
  static const bool started = sodium_init() >= 0;
  if (!started) throw std::runtime_error("libsodium cannot be used here");
}

/// Bytes that the destructor wipes from memory, also after an exception.
template <class T, std::size_t kSize>
struct Wiped : std::array<T, kSize> {
  Wiped() : std::array<T, kSize>{} {}
  ~Wiped() { sodium_memzero(this->data(), sizeof(T) * kSize); }
  Wiped(const Wiped&) = delete;
  Wiped& operator=(const Wiped&) = delete;
};

constexpr std::size_t kKeyDigits = 2 * std::tuple_size_v<SigningKey::Secret>;
// Room for a key, a line end of two characters, and one more character. A file that fills all this
// room is too long for a key.
using KeyText = Wiped<char, kKeyDigits + 3>;

/// Reads a file into `text`, at most until `text` is full.
/// @return the number of bytes; -1 with errno if the file cannot be read
ssize_t ReadAll(int fd, KeyText& text) {
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t more = read(fd, text.data() + size, text.size() - size);
    if (more < 0 && errno == EINTR) continue;
    if (more < 0) return -1;
    if (more == 0) break;
    size += static_cast<std::size_t>(more);
  }
  return static_cast<ssize_t>(size);
}

/// Whether a regular file was opened. Other files must not be read: a folder cannot be read, and a
/// pipe or device may have no data yet or no end.
bool IsFile(int fd) {
  struct stat info {};
  return fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
}

/// Why an open file is not a secret of this user; "" if it is a secret.
std::string WhyNoSecret(int fd, const std::filesystem::path& file) {
  struct stat info {};
  if (fstat(fd, &info) != 0) return std::strerror(errno);
  if (info.st_uid != geteuid() && info.st_uid != 0) {
    return fmt::format(
        "the key belongs to user {}, who can change it; copy it, or: chown {} {}; chmod 600 {}",
        info.st_uid, geteuid(), PathText(file), PathText(file));
  }
  if ((info.st_mode & (S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH)) != 0) {
    return fmt::format("others can read or change this key (mode {:03o}); chmod 600 {}",
                       info.st_mode & 0777U, PathText(file));
  }
  return "";
}

}  // namespace

SigningKey::~SigningKey() { sodium_memzero(secret_.data(), secret_.size()); }

SigningKey SigningKey::Load(const std::filesystem::path& file) {
  StartSodium();
  const OpenFile in(file);
  if (in.fd() >= 0 && !IsFile(in.fd())) throw KeyError(file, "cannot read the key: it is no file");
  KeyText text;
  const ssize_t size = in.fd() < 0 ? -1 : ReadAll(in.fd(), text);
  if (size < 0) {
    const int error = errno;
    ThrowIfExhausted(error, PathText(file));
    throw KeyError(file, fmt::format("cannot read the key: {}", std::strerror(error)));
  }
  std::string_view digits(text.data(), static_cast<std::size_t>(size));
  while (digits.ends_with('\n') || digits.ends_with('\r')) digits.remove_suffix(1);
  SigningKey key(Secret{});
  const bool whole = static_cast<std::size_t>(size) < text.size() && digits.size() == kKeyDigits &&
                     sodium_hex2bin(key.secret_.data(), key.secret_.size(), digits.data(),
                                    digits.size(), nullptr, nullptr, nullptr) == 0;
  if (!whole) {
    throw KeyError(file,
                   "not a key, which is 64 hexadecimal digits and nothing else; `fogline keygen "
                   "FILE` makes one");
  }
  // A script without a source of randomness may make a key of zeros, and an attacker tries this key
  // first.
  if (sodium_is_zero(key.secret_.data(), key.secret_.size()) == 1) {
    throw KeyError(file, "a key of zeros is no secret; `fogline keygen FILE` makes one");
  }
  if (const std::string why = WhyNoSecret(in.fd(), file); !why.empty()) throw KeyError(file, why);
  return key;
}

void SigningKey::Create(const std::filesystem::path& file) {
  StartSodium();
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (fd < 0) {
    ThrowIfExhausted(errno, PathText(file));
    throw KeyError(file, errno == EEXIST ? "exists; a key is not replaced"
                                         : fmt::format("cannot write: {}", std::strerror(errno)));
  }
  Wiped<std::uint8_t, std::tuple_size_v<Secret>> secret;
  randombytes_buf(secret.data(), secret.size());
  Wiped<char, kKeyDigits + 1> text;
  sodium_bin2hex(text.data(), text.size(), secret.data(), secret.size());
  text.back() = '\n';
  int error = WriteAll(fd, {text.data(), text.size()});
  if (error == 0 && fsync(fd) != 0) error = errno;
  close(fd);
  if (error == 0) return;
  unlink(file.c_str());
  throw std::runtime_error(
      fmt::format("{}: cannot write: {}", PathText(file), std::strerror(error)));
}

MessageSigner::KeyId MessageSigner::IdOf(const SigningKey& key) {
  StartSodium();
  std::array<std::uint8_t, crypto_generichash_BYTES> hash{};
  crypto_generichash(hash.data(), hash.size(), key.secret().data(), key.secret().size(), nullptr,
                     0);
  return {hash[0], hash[1]};
}

MessageSigner::Tag MessageSigner::TagOf(std::string_view channel, const Sender& sender,
                                        Bytes payload) const {
  const SigningKey::Secret& secret = key_.secret();
  constexpr std::uint8_t kEndOfName = 0;
  crypto_generichash_state state;
  crypto_generichash_init(&state, secret.data(), secret.size(), std::tuple_size_v<Tag>);
  crypto_generichash_update(&state, reinterpret_cast<const std::uint8_t*>(channel.data()),
                            channel.size());
  crypto_generichash_update(&state, &kEndOfName, 1);
  crypto_generichash_update(&state, sender.data(), sender.size());
  crypto_generichash_update(&state, payload.data(), payload.size());
  Tag tag{};
  crypto_generichash_final(&state, tag.data(), tag.size());
  sodium_memzero(&state, sizeof(state));  // the state may still contain the key
  return tag;
}

Bytes MessageSigner::Sign(std::string_view channel, Bytes payload) {
  const Role role = sender_ ? *sender_ : ProducerOf(channel, payload).value_or(Role::kRunner);
  const Sender sender{0, static_cast<std::uint8_t>(role)};
  const Tag tag = TagOf(channel, sender, payload);
  message_.assign(payload.begin(), payload.end());
  for (const Bytes part : {Bytes(kSignatureMagic), Bytes(id_), Bytes(sender), Bytes(tag)}) {
    message_.insert(message_.end(), part.begin(), part.end());
  }
  return message_;
}

MessageSigner::Opened MessageSigner::Open(std::string_view channel, Bytes message) const {
  if (!LooksSigned(message)) return {Verdict::kNotSigned, {}};
  const Bytes payload = WithoutSignature(message);
  const Bytes trailer = message.last(kSignatureBytes);
  Sender sender{};
  std::ranges::copy(trailer.subspan(kSenderOffset, sender.size()), sender.begin());
  const Tag tag = TagOf(channel, sender, payload);
  const bool good = std::ranges::equal(trailer.subspan(kKeyIdOffset, id_.size()), id_) &&
                    sodium_memcmp(tag.data(), trailer.data() + kTagOffset, tag.size()) == 0 &&
                    sender[0] == 0 && sender[1] <= static_cast<std::uint8_t>(Role::kRunner) &&
                    MaySend(static_cast<Role>(sender[1]), channel, payload);
  return good ? Opened{Verdict::kGood, payload} : Opened{Verdict::kBadlySigned, {}};
}

}  // namespace fogline::runtime
