#include "tools/web/types/lcm_parser.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/core.h>

#include "common/errors.h"
#include "common/text.h"
#include "tools/web/types/lcm_tokens.h"

namespace fogline::web {
namespace {

using Kind = LcmToken::Kind;

/// The integer that the text represents; nullopt if the text is not an integer.
std::optional<std::int64_t> IntegerIn(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
  if (hexadecimal) text.remove_prefix(2);
  std::uint64_t magnitude = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, magnitude, hexadecimal ? 16 : 10);
  if (error != std::errc() || stop != end) return std::nullopt;
  // A hexadecimal constant may have all 64 bits, as in C.
  constexpr std::uint64_t kLowest = std::uint64_t{1} << 63;
  if (!hexadecimal && magnitude > (negative ? kLowest : kLowest - 1)) return std::nullopt;
  return static_cast<std::int64_t>(negative ? 0 - magnitude : magnitude);
}

std::optional<double> RealIn(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

std::string Joined(const std::string& before, const std::string& behind) {
  return before.empty() || behind.empty() ? before + behind : before + " " + behind;
}

class Parser {
 public:
  Parser(std::string_view text, std::string_view file)
      : tokens_(LcmTokens(text, file)), file_(file) {}

  std::vector<LcmStruct> File() {
    std::vector<LcmStruct> structs;
    while (Peek().kind != Kind::kEnd) {
      if (Peek().text == "package") {
        Next();
        package_ = Word("the name of a package").text;
        Symbol(";");
      } else {
        structs.push_back(Struct());
      }
    }
    return structs;
  }

 private:
  const LcmToken& Peek() const { return tokens_[at_]; }
  const LcmToken& Next() { return tokens_[Peek().kind == Kind::kEnd ? at_ : at_++]; }

  const LcmToken& Word(std::string_view what) {
    if (Peek().kind != Kind::kWord) Fail(fmt::format("{} is missing", what));
    return Next();
  }
  /// A name that the file defines, such as the name of a struct or of a member. Such a name has no
  /// dots.
  const LcmToken& Name(std::string_view what) {
    const LcmToken& name = Word(what);
    if (name.text.find('.') != std::string::npos) Fail(fmt::format("{} has a dot", what), name);
    return name;
  }
  const LcmToken& Symbol(std::string_view symbol) {
    if (Peek().text != symbol) {
      Fail(fmt::format("expected {}, not {}", Quote(symbol),
                       Peek().kind == Kind::kEnd ? "the end" : Quote(Peek().text)));
    }
    return Next();
  }
  bool SymbolFollows(std::string_view symbol) {
    if (Peek().text != symbol) return false;
    Next();
    return true;
  }

  LcmStruct Struct() {
    LcmStruct type;
    type.package = package_;
    type.comment = Peek().comment_before;
    if (Peek().text != "struct")
      Fail(fmt::format("expected \"struct\", not {}", Quote(Peek().text)));
    Next();
    type.name = Name("the name of the struct").text;
    const LcmToken begin = Symbol("{");
    while (!SymbolFollows("}")) {
      if (Peek().text == "const") {
        Constants(type);
      } else {
        Members(type);
      }
    }
    if (type.members.empty()) Fail(fmt::format("{} has no members", type.name), begin);
    return type;
  }

  void Constants(LcmStruct& type) {
    const std::string comment = Next().comment_before;
    const LcmToken& kind = Word("the type of the constant");
    const std::size_t first = type.constants.size();
    do {
      LcmConstant constant;
      constant.type = kind.text;
      constant.comment = Joined(comment, Peek().comment_before);
      constant.name = Name("the name of the constant").text;
      Symbol("=");
      constant.value = Value(constant.type);
      type.constants.push_back(std::move(constant));
    } while (SymbolFollows(","));
    const std::string behind = Symbol(";").comment_behind;
    for (std::size_t i = first; i < type.constants.size(); ++i) {
      type.constants[i].comment = Joined(type.constants[i].comment, behind);
    }
  }

  std::variant<std::int64_t, double> Value(std::string_view type) {
    const LcmToken& token = Next();
    const auto primitive = PrimitiveNamed(type);
    if (primitive && MayBeLength(*primitive)) {
      if (const auto value = IntegerIn(token.text)) return *value;
    } else if (primitive == LcmPrimitive::kFloat || primitive == LcmPrimitive::kDouble) {
      if (const auto value = RealIn(token.text)) return *value;
    } else {
      Fail(fmt::format("no constant has the type {}", Quote(type)), token);
    }
    Fail(fmt::format("{} is no value of {}", Quote(token.text), Quote(type)), token);
  }

  void Members(LcmStruct& type) {
    const LcmToken& kind = Word("the type of the member");
    const std::string comment = kind.comment_before;
    const std::size_t first = type.members.size();
    do {
      LcmMember member;
      member.type = kind.text;
      member.primitive = PrimitiveNamed(kind.text);
      member.comment = Joined(comment, Peek().comment_before);
      const LcmToken& name = Name("the name of the member");
      member.name = name.text;
      if (std::ranges::find(type.members, member.name, &LcmMember::name) != type.members.end()) {
        Fail(fmt::format("there are two members {}", Quote(member.name)), name);
      }
      while (SymbolFollows("[")) {
        member.dimensions.push_back(Dimension(type));
        Symbol("]");
      }
      if (member.dimensions.size() > kMaxDimensions) {
        Fail(fmt::format("{} has more than {} dimensions", member.name, kMaxDimensions), name);
      }
      type.members.push_back(std::move(member));
    } while (SymbolFollows(","));
    const std::string behind = Symbol(";").comment_behind;
    for (std::size_t i = first; i < type.members.size(); ++i) {
      type.members[i].comment = Joined(type.members[i].comment, behind);
    }
  }

  LcmDimension Dimension(LcmStruct& type) {
    const LcmToken& token = Next();
    LcmDimension dimension{.size = token.text, .fixed = std::nullopt};
    if (token.kind == Kind::kNumber) {
      const auto size = IntegerIn(token.text);
      if (!size || *size <= 0) {
        Fail(fmt::format("{} is no length of an array", Quote(token.text)), token);
      }
      dimension.fixed = static_cast<std::size_t>(*size);
      return dimension;
    }
    const auto length = std::ranges::find(type.members, token.text, &LcmMember::name);
    if (length == type.members.end() || !length->dimensions.empty() || !length->primitive ||
        !MayBeLength(*length->primitive)) {
      Fail(fmt::format("{} is no length: it must be a number, or an integer member that stands "
                       "before the array",
                       Quote(token.text)),
           token);
    }
    if (!length->length_slot) length->length_slot = NextSlot(type, token);
    dimension.slot = *length->length_slot;
    return dimension;
  }

  std::size_t NextSlot(const LcmStruct& type, const LcmToken& token) const {
    const auto slots = static_cast<std::size_t>(std::ranges::count_if(
        type.members, [](const LcmMember& member) { return member.length_slot.has_value(); }));
    if (slots == kMaxLengths) {
      Fail(fmt::format("more than {} members are lengths", kMaxLengths), token);
    }
    return slots;
  }

  [[noreturn]] void Fail(std::string_view what) const { Fail(what, Peek()); }
  [[noreturn]] void Fail(std::string_view what, const LcmToken& token) const {
    throw InputError(fmt::format("{}:{}: error: {}", file_, token.line, what));
  }

  std::vector<LcmToken> tokens_;
  std::string_view file_;
  std::size_t at_ = 0;
  std::string package_;
};

}  // namespace

std::vector<LcmStruct> ParseLcm(std::string_view text, std::string_view file) {
  return Parser(text, file).File();
}

}  // namespace fogline::web
