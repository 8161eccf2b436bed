#include "services/runtime/seal.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/core.h>

#include "scenario/loader.h"

namespace fogline {
namespace {

constexpr std::size_t kKeyIdOffset = kSealMagic.size();
constexpr std::size_t kSenderOffset = kKeyIdOffset + 2;
constexpr std::size_t kTagOffset = kSenderOffset + 2;

/// The role that a STATUS says that it is from: its first field behind the header, a string as LCM
/// encodes it (int32 length with the final 0, then the characters).
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

/// Whose message this is if it is what it says; nothing if anybody may send it.
std::optional<Role> ProducerOf(std::string_view channel, Bytes payload) {
  if (channel == ChannelOf<status_t>().name) {
    const std::string_view name = RoleNamedIn(payload);
    for (const RoleInfo& info : kRoles) {
      if (info.name == name) return info.role;
    }
    return Role::kRunner;  // who sends none
  }
  if (channel == ChannelOf<resend_t>().name) return std::nullopt;
  const auto* found = std::ranges::find(kChannels, channel, &ChannelInfo::name);
  if (found == kChannels.end()) return std::nullopt;
  return found->from;
}

/// The recorder answers for steps that their producers have forgotten.
bool MaySend(Role sender, std::string_view channel, Bytes payload) {
  const auto* found = std::ranges::find(kChannels, channel, &ChannelInfo::name);
  const bool step = found != kChannels.end() && found->pace == Pace::kStep;
  return ProducerOf(channel, payload).value_or(sender) == sender ||
         (step && sender == Role::kRecorder);
}

InputError KeyError(const std::filesystem::path& file, const std::string& what) {
  return InputError(fmt::format("{}: error: {}", file.string(), what));
}

}  // namespace

SealKey::~SealKey() { sodium_memzero(secret_.data(), secret_.size()); }

SealKey SealKey::Load(const std::filesystem::path& file) {
  std::ifstream in(file);
  // One character more than a key and its line end: a longer file is none.
  std::array<char, 2 * std::tuple_size_v<Secret> + 3> text{};
  in.read(text.data(), text.size());
  if (in.bad() || (in.gcount() == 0 && in.fail() && !in.eof())) {
    throw KeyError(file, fmt::format("cannot read the key: {}", std::strerror(errno)));
  }
  std::string_view digits(text.data(), static_cast<std::size_t>(in.gcount()));
  while (digits.ends_with('\n') || digits.ends_with('\r')) digits.remove_suffix(1);
  Secret secret{};
  const bool whole = digits.size() == 2 * secret.size() &&
                     sodium_hex2bin(secret.data(), secret.size(), digits.data(), digits.size(),
                                    nullptr, nullptr, nullptr) == 0;
  sodium_memzero(text.data(), text.size());
  if (!whole) {
    throw KeyError(file,
                   "not a key, which is 64 hexadecimal digits and nothing else; `fogline keygen "
                   "FILE` makes one");
  }
  const SealKey key(secret);
  sodium_memzero(secret.data(), secret.size());
  return key;
}

void SealKey::Create(const std::filesystem::path& file) {
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (fd < 0) {
    throw KeyError(file, errno == EEXIST ? "exists; a key is not replaced"
                                         : fmt::format("cannot write: {}", std::strerror(errno)));
  }
  Secret secret{};
  randombytes_buf(secret.data(), secret.size());
  std::array<char, 2 * std::tuple_size_v<Secret> + 1> text{};
  sodium_bin2hex(text.data(), text.size(), secret.data(), secret.size());
  text.back() = '\n';
  const bool written = write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  sodium_memzero(secret.data(), secret.size());
  sodium_memzero(text.data(), text.size());
  if (close(fd) != 0 || !written) {
    const std::string why = std::strerror(errno);
    unlink(file.c_str());
    throw KeyError(file, fmt::format("cannot write: {}", why));
  }
}

std::string KeyFileWarning(const std::filesystem::path& file) {
  struct stat info {};
  if (stat(file.c_str(), &info) != 0 || (info.st_mode & (S_IRWXG | S_IRWXO)) == 0) return "";
  return fmt::format("{}: warning: others can read this key; chmod 600 would keep it secret",
                     file.string());
}

Seal::KeyId Seal::IdOf(const SealKey& key) {
  std::array<std::uint8_t, crypto_generichash_BYTES> hash{};
  crypto_generichash(hash.data(), hash.size(), key.secret().data(), key.secret().size(), nullptr,
                     0);
  return {hash[0], hash[1]};
}

Seal::Tag Seal::TagOf(std::string_view channel, const Sender& sender, Bytes payload) const {
  const SealKey::Secret& secret = key_.secret();
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
  return tag;
}

Bytes Seal::Sign(std::string_view channel, Bytes payload) {
  const Role role = sender_ ? *sender_ : ProducerOf(channel, payload).value_or(Role::kRunner);
  const Sender sender{0, static_cast<std::uint8_t>(role)};
  const Tag tag = TagOf(channel, sender, payload);
  message_.assign(payload.begin(), payload.end());
  for (const Bytes part : {Bytes(kSealMagic), Bytes(id_), Bytes(sender), Bytes(tag)}) {
    message_.insert(message_.end(), part.begin(), part.end());
  }
  return message_;
}

Seal::Opened Seal::Open(std::string_view channel, Bytes message) const {
  if (!LooksSealed(message)) return {Verdict::kNotSigned, {}};
  const Bytes payload = WithoutSeal(message);
  const Bytes trailer = message.last(kSealBytes);
  Sender sender{};
  std::ranges::copy(trailer.subspan(kSenderOffset, sender.size()), sender.begin());
  const Tag tag = TagOf(channel, sender, payload);
  const bool good = std::ranges::equal(trailer.subspan(kKeyIdOffset, id_.size()), id_) &&
                    sodium_memcmp(tag.data(), trailer.data() + kTagOffset, tag.size()) == 0 &&
                    sender[0] == 0 && sender[1] <= static_cast<std::uint8_t>(Role::kRunner) &&
                    MaySend(static_cast<Role>(sender[1]), channel, payload);
  return good ? Opened{Verdict::kGood, payload} : Opened{Verdict::kBadlySigned, {}};
}

}  // namespace fogline
