#include "tools/web/types/lcm_types.h"

#include <algorithm>
#include <bit>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "tools/web/types/lcm_parser.h"
#include "tools/web/types/lcm_texts.h"
#include "tools/web/types/wire_cursor.h"

namespace fogline::web {
namespace {

// The states of a struct in Complete().
constexpr int kUntouched = 0;
constexpr int kUnderWay = 1;
constexpr int kComplete = 2;

/// Whether `named` means the struct `type`. `named` is the type of a member of the struct `user`. A
/// name without a package means a struct of the same package.
bool Means(std::string_view named, const LcmStruct& user, const LcmStruct& type) {
  if (named.find('.') != std::string_view::npos) return named == type.FullName();
  return named == type.name && user.package == type.package;
}

std::vector<LcmStruct> ParseTexts() {
  std::vector<LcmStruct> structs;
  for (const LcmText& text : LcmTexts()) {
    std::ranges::move(ParseLcm(text.text, text.file), std::back_inserter(structs));
  }
  return structs;
}

}  // namespace

LcmTypes::LcmTypes(std::vector<LcmStruct> structs) : structs_(std::move(structs)) {
  std::set<std::string> names;
  for (const LcmStruct& type : structs_) {
    if (!names.insert(type.FullName()).second) {
      throw InputError(fmt::format("there are two structs {}", type.FullName()));
    }
  }
  for (LcmStruct& type : structs_) {
    for (LcmMember& member : type.members) {
      if (member.primitive) continue;
      const auto nested = std::ranges::find_if(structs_, [&](const LcmStruct& candidate) {
        return Means(member.type, type, candidate);
      });
      if (nested == structs_.end()) {
        throw InputError(
            fmt::format("{}.{}: there is no struct {}", type.FullName(), member.name, member.type));
      }
      member.nested = static_cast<std::size_t>(nested - structs_.begin());
    }
  }
  std::vector<int> states(structs_.size(), kUntouched);
  for (std::size_t place = 0; place < structs_.size(); ++place) Complete(place, states);
}

std::optional<std::size_t> LcmTypes::FixedSize(const LcmMember& member) const {
  std::optional<std::size_t> size;
  if (!member.primitive) {
    size = StructOf(member).fixed_size;
  } else if (*member.primitive != LcmPrimitive::kString) {
    size = WireSize(*member.primitive);
  }
  for (const LcmDimension& dimension : member.dimensions) {
    if (!size || !dimension.fixed) return std::nullopt;
    // No message has room for more elements. Without this limit the product could overflow.
    if (*dimension.fixed > kLargestMessage) return std::nullopt;
    *size *= *dimension.fixed;
    if (*size > kLargestMessage) return std::nullopt;
  }
  return size;
}

/// Computes the fingerprint and the size of a struct. First does the same for the structs in it.
void LcmTypes::Complete(std::size_t place, std::vector<int>& states) {
  if (states[place] == kComplete) return;
  LcmStruct& type = structs_[place];
  if (states[place] == kUnderWay) {
    throw InputError(fmt::format("{} contains itself", type.FullName()));
  }
  states[place] = kUnderWay;
  // lcm-gen adds the fingerprints of the structs to the struct's own hash, and rotates the sum by
  // one bit.
  auto sum = static_cast<std::uint64_t>(OwnHash(type));
  type.fixed_size = 0;
  for (const LcmMember& member : type.members) {
    if (!member.primitive) {
      Complete(member.nested, states);
      sum += static_cast<std::uint64_t>(StructOf(member).fingerprint);
    }
    const auto size = FixedSize(member);
    if (!size || !type.fixed_size) {
      type.fixed_size.reset();
    } else {
      *type.fixed_size += *size;
    }
  }
  type.fingerprint = static_cast<std::int64_t>(std::rotl(sum, 1));
  states[place] = kComplete;
}

const LcmStruct* LcmTypes::Named(std::string_view name) const {
  const auto type = std::ranges::find(structs_, name, &LcmStruct::name);
  return type == structs_.end() ? nullptr : &*type;
}

const LcmStruct* LcmTypes::WithFingerprint(std::int64_t fingerprint) const {
  const auto type = std::ranges::find(structs_, fingerprint, &LcmStruct::fingerprint);
  return type == structs_.end() ? nullptr : &*type;
}

const LcmStruct* LcmTypes::TypeOf(Bytes message) const {
  WireCursor cursor(message);
  const auto fingerprint = cursor.Integer(LcmPrimitive::kInt64);
  return fingerprint ? WithFingerprint(*fingerprint) : nullptr;
}

const LcmTypes& FoglineTypes() {
  static const LcmTypes types(ParseTexts());
  return types;
}

}  // namespace fogline::web
