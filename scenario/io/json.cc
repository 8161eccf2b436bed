#include "scenario/io/json.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "common/text.h"
#include "scenario/sections/field_view.h"

namespace fogline {
namespace {

constexpr std::size_t kMaxDepth = 32;
constexpr std::size_t kMaxValues = 2'000'000;

// Iterator that passes a text to nlohmann's lexer and counts the characters that the lexer has
// read.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, std::size_t* consumed) : at_(at), consumed_(consumed) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    ++*consumed_;
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator old = *this;
    ++*this;
    return old;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  std::size_t* consumed_;
};

// Rewrites a message of nlohmann for a person, without the excerpts of the text. nlohmann's message
// has the form "... syntax error while parsing value - invalid literal; last read: '"a":N';
// expected '['".
std::string SyntaxDetail(std::string_view what) {
  if (what.find("number overflow") != std::string_view::npos) return "a number beyond 1.8e308";
  std::string_view expected;
  if (what.find("while parsing object key") != std::string_view::npos) {
    expected = "; expected a key in double quotes";
  } else if (what.find("while parsing object - ") != std::string_view::npos) {
    expected = "; expected ',' or '}'";
  } else if (what.find("while parsing array - ") != std::string_view::npos) {
    expected = "; expected ',' or ']'";
  } else if (const std::size_t at = what.rfind("; expected "); at != std::string_view::npos) {
    expected = what.substr(at);
  }
  what.remove_prefix(std::min(what.find(" - ") + 3, what.size()));
  what = what.substr(0, std::min(what.find("; last read: "), what.find("; expected ")));
  return std::string(what).append(expected);
}

// A likely reason for a syntax error at `offset`, or nothing.
std::string_view SyntaxHint(std::string_view text, std::size_t offset) {
  if (offset >= text.size()) return "";
  const char before = offset > 0 ? text[offset - 1] : ' ';
  if (before == '0' && text[offset] >= '0' && text[offset] <= '9') {
    return " (JSON has no leading zeros)";
  }
  switch (text[offset]) {
    case '/':
    case '#':
      return " (JSON has no comments)";
    case '\'':
      return " (JSON has texts and keys in double quotes)";
    case 'N':
    case 'I':
      return " (JSON has no NaN and no Infinity)";
    case '}':
    case ']': {
      const std::size_t last = text.substr(0, offset).find_last_not_of(" \t\r\n");
      const bool comma = last != std::string_view::npos && text[last] == ',';
      return comma ? " (JSON has no comma after the last item)" : "";
    }
    default:
      return "";
  }
}

// Builds the tree from the parser's events. The parser keeps its own stack on the heap, so deep
// nesting needs no call stack.
class TreeBuilder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(std::string_view text, std::uint32_t source, DiagnosticList& mistakes,
              std::string_view base)
      : text_(text),
        source_(source),
        mistakes_(mistakes),
        base_(base),
        end_(SkipByteOrderMark(text)) {}

  bool Parse() {
    return nlohmann::json::sax_parse(CountingIterator(text_.data(), &consumed_),
                                     CountingIterator(text_.data() + text_.size(), &consumed_),
                                     this);
  }
  JsonValue TakeRoot() { return std::move(root_); }

  bool null() override { return Put(std::monostate{}) != nullptr; }
  bool boolean(bool value) override { return Put(value) != nullptr; }
  bool number_integer(number_integer_t value) override { return PutNumber(value); }
  bool number_unsigned(number_unsigned_t value) override {
    if (value <= static_cast<number_unsigned_t>(std::numeric_limits<std::int64_t>::max())) {
      return PutNumber(static_cast<std::int64_t>(value));
    }
    return PutNumber(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return PutNumber(value); }
  bool string(string_t& value) override { return Put(std::move(value)) != nullptr; }
  bool binary(binary_t&) override { return false; }

  bool start_object(std::size_t) override { return Open(JsonObject{}); }
  bool start_array(std::size_t) override { return Open(JsonArray{}); }
  bool key(string_t& key) override {
    const Place place = TokenPlace();
    open_.back()->As<JsonObject>()->push_back({.key = std::move(key), .place = place, .value = {}});
    return true;
  }
  bool end_object() override {
    FindDuplicates(*open_.back()->As<JsonObject>());
    return Close();
  }
  bool end_array() override { return Close(); }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    // `position` is one after the byte at which the parser stopped. The mistake is reported at the
    // start of the token. But a mistake in a string is reported at the byte at which the parser
    // stopped, because a string may be long.
    const std::string detail = EscapeControls(SyntaxDetail(error.what()));
    const std::size_t last = std::max<std::size_t>(position, 1) - 1;
    const std::size_t offset =
        detail.starts_with("invalid string") ? last : std::min(TokenStart(), last);
    return Fail(offset, "syntax", fmt::format("not JSON: {}{}", detail, SyntaxHint(text_, offset)));
  }

 private:
  // First byte of the token that was just read. Only space and punctuation lie between the previous
  // token and this token.
  std::size_t TokenStart() const {
    const std::size_t start = text_.find_first_not_of(" \t\r\n,:", end_);
    return start == std::string_view::npos ? text_.size() : start;
  }
  Place TokenPlace() {
    const Place place{.source = source_, .offset = static_cast<std::uint32_t>(TokenStart())};
    end_ = consumed_;
    return place;
  }

  template <class T>
  JsonValue* Put(T value) {
    JsonValue node{.data = std::move(value), .place = TokenPlace()};
    if (++count_ > kMaxValues) {
      Fail(node.place.offset, "too-large",
           fmt::format("more than {} values; no scenario has that many", kMaxValues));
      return nullptr;
    }
    if (open_.empty()) return &(root_ = std::move(node));
    if (auto* array = open_.back()->As<JsonArray>()) return &array->emplace_back(std::move(node));
    return &(open_.back()->As<JsonObject>()->back().value = std::move(node));
  }

  // To find the end of a number, the lexer reads one more byte, except at the end of the text. So
  // the number ends before this byte.
  template <class T>
  bool PutNumber(T value) {
    if (Put(value) == nullptr) return false;
    if (consumed_ < text_.size()) end_ = consumed_ - 1;
    return true;
  }

  // Pointers to open containers stay valid, because a container does not grow while a container
  // inside it is open.
  template <class T>
  bool Open(T container) {
    JsonValue* node = Put(std::move(container));
    if (node == nullptr) return false;
    open_.push_back(node);
    if (open_.size() <= kMaxDepth) return true;
    return Fail(node->place.offset, "too-large",
                fmt::format("nested deeper than {} levels; no scenario needs more", kMaxDepth));
  }
  bool Close() {
    end_ = consumed_;
    open_.pop_back();
    return true;
  }

  bool Fail(std::size_t offset, std::string_view rule, std::string message) {
    mistakes_.Add({.source = source_, .offset = static_cast<std::uint32_t>(offset)},
                  std::string(base_), rule, std::move(message));
    return false;
  }

  void FindDuplicates(const JsonObject& object) {
    std::vector<std::size_t> order(object.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&object](std::size_t a, std::size_t b) {
      return object[a].key < object[b].key;
    });
    for (std::size_t i = 1; i < order.size(); ++i) {
      const JsonMember& member = object[order[i]];
      if (member.key != object[order[i - 1]].key) continue;
      mistakes_.Add(member.place, JoinPointer(OpenPointer(), member.key), "duplicate-key",
                    "duplicate key; it already has a value above; remove one of them");
    }
  }

  // Pointer of the innermost open container.
  std::string OpenPointer() const {
    std::string pointer(base_);
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
      const auto* array = open_[i]->As<JsonArray>();
      pointer = JoinPointer(pointer, array ? std::to_string(array->size() - 1)
                                           : open_[i]->As<JsonObject>()->back().key);
    }
    return pointer;
  }

  std::string_view text_;
  std::uint32_t source_;
  DiagnosticList& mistakes_;
  std::string_view base_;
  JsonValue root_;
  std::vector<JsonValue*> open_;
  std::size_t consumed_ = 0;  // bytes that the lexer has read
  std::size_t end_;           // where the previous token ended
  std::size_t count_ = 0;
};

template <class Object>
auto* Find(Object& object, std::string_view key) {
  const auto it = std::find_if(object.begin(), object.end(),
                               [key](const JsonMember& member) { return member.key == key; });
  return it == object.end() ? nullptr : &*it;
}

struct DescribeKind {
  std::string operator()(std::monostate) const { return "null"; }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(std::int64_t value) const { return fmt::format("the number {}", value); }
  std::string operator()(double value) const { return "the number " + NumberText(value); }
  std::string operator()(const std::string& text) const { return "the text " + QuoteShort(text); }
  std::string operator()(const JsonArray&) const { return "a list"; }
  std::string operator()(const JsonObject&) const { return "an object"; }
};

}  // namespace

const JsonMember* FindMember(const JsonObject& object, std::string_view key) {
  return Find(object, key);
}
JsonMember* FindMember(JsonObject& object, std::string_view key) { return Find(object, key); }

Place FindPlace(const JsonValue& root, std::string_view pointer) {
  const JsonValue* at = &root;
  while (!pointer.empty()) {
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    const std::string_view segment = pointer.substr(1, end - 1);
    const JsonValue* inner = nullptr;
    if (const auto* object = at->As<JsonObject>()) {
      const JsonMember* member = FindMember(*object, segment);
      inner = member == nullptr ? nullptr : &member->value;
    } else if (const auto* list = at->As<JsonArray>()) {
      const auto index = ListIndex(segment);
      inner = index && *index < list->size() ? &(*list)[*index] : nullptr;
    }
    if (inner == nullptr) break;
    at = inner;
    pointer.remove_prefix(end);
  }
  return at->place;
}

std::string Describe(const JsonValue& value) { return std::visit(DescribeKind{}, value.data); }

std::string JoinPointer(std::string_view base, std::string_view key) {
  std::string pointer(base);
  pointer += '/';
  for (const char c : key) {
    if (c == '~') {
      pointer += "~0";
    } else if (c == '/') {
      pointer += "~1";
    } else {
      pointer += c;
    }
  }
  return pointer;
}

std::optional<JsonValue> ParseJson(std::string_view text, std::uint32_t source,
                                   DiagnosticList& mistakes, std::string_view base) {
  const auto refuse = [&](std::size_t offset, std::string_view rule, std::string message) {
    mistakes.Add({.source = source, .offset = static_cast<std::uint32_t>(offset)},
                 std::string(base), rule, std::move(message));
    return std::nullopt;
  };
  if (text.size() > kMaxFileBytes) {
    return refuse(0, "too-large", fmt::format("larger than {} bytes", kMaxFileBytes));
  }
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    return refuse(0, "syntax", "not JSON: the text is UTF-16; save it as UTF-8");
  }
  // The lexer would treat a NUL byte as the end of the text.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    return refuse(nul, "syntax", "not JSON: a NUL byte");
  }
  TreeBuilder builder(text, source, mistakes, base);
  if (!builder.Parse()) return std::nullopt;
  return builder.TakeRoot();
}

}  // namespace fogline
