#include "services/runtime/wire/digest.h"

#include <sodium.h>

#include <array>

namespace fogline::runtime {
namespace {

constexpr std::size_t kHashBytes = 32;

std::string ToHex(const std::array<unsigned char, kHashBytes>& hash) {
  std::array<char, 2 * kHashBytes + 1> hex{};
  sodium_bin2hex(hex.data(), hex.size(), hash.data(), hash.size());
  return hex.data();
}

}  // namespace

struct Hash::State {
  crypto_generichash_state hash;
};

Hash::Hash() : state_(std::make_unique<State>()) {
  crypto_generichash_init(&state_->hash, nullptr, 0, kHashBytes);
}
Hash::~Hash() = default;
Hash::Hash(Hash&&) noexcept = default;
Hash& Hash::operator=(Hash&&) noexcept = default;

void Hash::Add(Bytes piece) {
  crypto_generichash_update(&state_->hash, piece.data(), piece.size());
}

std::string Hash::Hex() const {
  crypto_generichash_state copy = state_->hash;
  std::array<unsigned char, kHashBytes> hash{};
  crypto_generichash_final(&copy, hash.data(), hash.size());
  return ToHex(hash);
}

std::string HashOf(std::string_view text) {
  std::array<unsigned char, kHashBytes> hash{};
  crypto_generichash(hash.data(), hash.size(), reinterpret_cast<const unsigned char*>(text.data()),
                     text.size(), nullptr, 0);
  return ToHex(hash);
}

}  // namespace fogline::runtime
