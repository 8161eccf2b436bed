#include "scenario/io/reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "scenario/sections/field_text.h"

namespace fogline {
namespace {

std::optional<double> ToNumber(const JsonValue& value) {
  if (const auto* integer = value.As<std::int64_t>()) return static_cast<double>(*integer);
  if (const auto* number = value.As<double>()) return *number;
  return std::nullopt;
}

// Accepts 3 and 3.0, as JSON schema does. A number beyond int64 becomes the nearest limit of int64,
// which is outside the range of every field.
std::optional<std::int64_t> ToInteger(const JsonValue& value) {
  if (const auto* integer = value.As<std::int64_t>()) return *integer;
  const auto* number = value.As<double>();
  if (number == nullptr || std::trunc(*number) != *number) return std::nullopt;
  constexpr double kLimit = 0x1p63;
  if (*number >= kLimit) return std::numeric_limits<std::int64_t>::max();
  if (*number < -kLimit) return std::numeric_limits<std::int64_t>::min();
  return static_cast<std::int64_t>(*number);
}

// The number approximately as it is written in the file. @pre ToNumber(value)
std::string TextOfNumber(const JsonValue& value) {
  if (const auto* integer = value.As<std::int64_t>()) return std::to_string(*integer);
  return NumberText(*ToNumber(value));
}

// A likely reason for a wrong type, or nothing.
std::string_view QuotesHint(const JsonValue& value) {
  const auto* text = value.As<std::string>();
  if (text == nullptr) return "";
  DiagnosticList ignored;
  const std::optional<JsonValue> inner = ParseJson(*text, 0, ignored);
  const bool bare = inner && (ToNumber(*inner) || inner->As<bool>() != nullptr);
  return bare ? "; did you mean it without quotes?" : "";
}

// Visits one object: a section, an item of a list, or the whole scenario.
class ObjectReader {
 public:
  ObjectReader(const JsonObject& object, Place place, std::string pointer, DiagnosticList& mistakes)
      : object_(object), place_(place), pointer_(std::move(pointer)), mistakes_(mistakes) {}

  void Number(std::string_view name, double& out, const NumberSpec& spec) {
    if (const JsonValue* value = Take(name)) ReadNumber(*value, Pointer(name), out, spec);
  }
  void Integer(std::string_view name, std::int64_t& out, const IntegerSpec& spec);
  void Flag(std::string_view name, bool& out, std::string_view doc);
  void Text(std::string_view name, std::string& out, std::string_view doc);
  void Numbers(std::string_view name, std::vector<double>& out, const NumberSpec& spec,
               const ListSpec& list);

  template <class Enum>
  void Choice(std::string_view name, Enum& out, std::string_view /*doc*/) {
    const JsonValue* value = Take(name);
    if (value == nullptr) return;
    const std::optional<std::size_t> index =
        ReadChoice(*value, Pointer(name), ChoiceNames<Enum>::kNames);
    if (index) out = static_cast<Enum>(*index);
  }
  template <class T>
  void Section(std::string_view name, T& out, std::string_view /*doc*/) {
    if (const JsonValue* value = Take(name)) ReadObject(*value, Pointer(name), out);
  }
  template <class T>
  void List(std::string_view name, std::vector<T>& out, const ListSpec& list) {
    const JsonArray* items = TakeList(name, list);
    if (items == nullptr) return;
    out.assign(items->size(), T{});
    const std::string base = Pointer(name);
    for (std::size_t i = 0; i < items->size(); ++i) {
      ReadObject((*items)[i], fmt::format("{}/{}", base, i), out[i]);
    }
  }
  void Needs(const NeedSpec& spec);

  // Refuses every key that no field has taken; call it after all fields.
  void RefuseUnknownKeys();
  void Require(std::string_view name, std::string_view example);

  // Reads the value as an object with the fields of T.
  template <class T>
  void ReadObject(const JsonValue& value, std::string pointer, T& out) {
    const auto* object = value.As<JsonObject>();
    if (object == nullptr) return Refuse(value, std::move(pointer), "an object");
    ObjectReader reader(*object, value.place, std::move(pointer), mistakes_);
    T::Fields(out, reader);
    reader.RefuseUnknownKeys();
  }

 private:
  std::string Pointer(std::string_view name) const { return JoinPointer(pointer_, name); }

  // The value of a key; null if the object lacks it. From then on the key is known.
  const JsonValue* Take(std::string_view name) {
    known_.push_back(name);
    const JsonMember* member = FindMember(object_, name);
    return member == nullptr ? nullptr : &member->value;
  }
  const JsonArray* TakeList(std::string_view name, const ListSpec& list);

  void ReadNumber(const JsonValue& value, std::string pointer, double& out, const NumberSpec& spec);
  std::optional<std::size_t> ReadChoice(const JsonValue& value, std::string pointer,
                                        std::span<const std::string_view> names);
  std::string UnknownKeyMessage(std::string_view key) const;

  // Notes a wrong type.
  void Refuse(const JsonValue& value, std::string pointer, std::string_view allowed,
              std::string_view hint = "") {
    mistakes_.Add(value.place, std::move(pointer), "type",
                  fmt::format("must be {}, not {}{}", allowed, Describe(value), hint));
  }

  const JsonObject& object_;
  Place place_;
  std::string pointer_;
  DiagnosticList& mistakes_;
  std::vector<std::string_view> known_;
};

void ObjectReader::ReadNumber(const JsonValue& value, std::string pointer, double& out,
                              const NumberSpec& spec) {
  const std::optional<double> number = ToNumber(value);
  if (!number) {
    return Refuse(value, std::move(pointer), Allowed(spec), QuotesHint(value));
  }
  if (*number < spec.min || *number > spec.max) {
    mistakes_.Add(value.place, std::move(pointer), "range",
                  fmt::format("{} is outside {}", TextOfNumber(value), Range(spec)));
    return;
  }
  out = *number;
}

void ObjectReader::Integer(std::string_view name, std::int64_t& out, const IntegerSpec& spec) {
  const JsonValue* value = Take(name);
  if (value == nullptr) return;
  const std::optional<std::int64_t> integer = ToInteger(*value);
  if (!integer) return Refuse(*value, Pointer(name), Allowed(spec), QuotesHint(*value));
  if (*integer < spec.min || *integer > spec.max) {
    const std::string number = TextOfNumber(*value);
    mistakes_.Add(value->place, Pointer(name), "range",
                  spec.min == spec.max ? fmt::format("must be {}, not {}", Allowed(spec), number)
                                       : fmt::format("{} is outside {}", number, Range(spec)));
    return;
  }
  out = *integer;
}

void ObjectReader::Flag(std::string_view name, bool& out, std::string_view /*doc*/) {
  const JsonValue* value = Take(name);
  if (value == nullptr) return;
  const auto* flag = value->As<bool>();
  if (flag == nullptr) return Refuse(*value, Pointer(name), "true or false", QuotesHint(*value));
  out = *flag;
}

void ObjectReader::Text(std::string_view name, std::string& out, std::string_view /*doc*/) {
  const JsonValue* value = Take(name);
  if (value == nullptr) return;
  const auto* text = value->As<std::string>();
  if (text == nullptr) return Refuse(*value, Pointer(name), "a text");
  const std::size_t length = CountCharacters(*text);
  if (length > static_cast<std::size_t>(kMaxTextLength)) {
    mistakes_.Add(value->place, Pointer(name), "text",
                  fmt::format("{} characters; allowed are {}", length, kMaxTextLength));
  } else if (HasControlCharacter(*text)) {
    mistakes_.Add(value->place, Pointer(name), "text",
                  fmt::format("a control character, which is not allowed: {}", QuoteShort(*text)));
  } else {
    out = *text;
  }
}

std::optional<std::size_t> ObjectReader::ReadChoice(const JsonValue& value, std::string pointer,
                                                    std::span<const std::string_view> names) {
  const auto* text = value.As<std::string>();
  if (text == nullptr) {
    Refuse(value, std::move(pointer), "one of " + Names(names));
    return std::nullopt;
  }
  const auto it = std::find(names.begin(), names.end(), *text);
  if (it != names.end()) return static_cast<std::size_t>(it - names.begin());
  mistakes_.Add(value.place, std::move(pointer), "choice",
                fmt::format("{} is not one of {}{}", QuoteShort(*text), Names(names),
                            DidYouMean(Nearest(*text, names))));
  return std::nullopt;
}

const JsonArray* ObjectReader::TakeList(std::string_view name, const ListSpec& list) {
  const JsonValue* value = Take(name);
  if (value == nullptr) return nullptr;
  const auto* items = value->As<JsonArray>();
  if (items == nullptr) {
    Refuse(*value, Pointer(name), fmt::format("a list of {} items", Range(list)));
    return nullptr;
  }
  const auto count = static_cast<std::int64_t>(items->size());
  if (count >= list.min_items && count <= list.max_items) return items;
  mistakes_.Add(value->place, Pointer(name), "list-length",
                fmt::format("{} items; allowed are {}", count, Range(list)));
  return nullptr;
}

void ObjectReader::Numbers(std::string_view name, std::vector<double>& out, const NumberSpec& spec,
                           const ListSpec& list) {
  const JsonArray* items = TakeList(name, list);
  if (items == nullptr) return;
  out.assign(items->size(), 0.0);
  for (std::size_t i = 0; i < items->size() && !mistakes_.full(); ++i) {
    const JsonValue& item = (*items)[i];
    if (const std::optional<double> n = ToNumber(item); n && *n >= spec.min && *n <= spec.max) {
      out[i] = *n;
    } else {
      ReadNumber(item, fmt::format("{}/{}", Pointer(name), i), out[i], spec);
    }
  }
}

void ObjectReader::Needs(const NeedSpec& spec) {
  const JsonMember* choice = FindMember(object_, spec.choice);
  if (choice == nullptr) return;
  const auto* text = choice->value.As<std::string>();
  if (text == nullptr || *text != spec.value) return;
  if (const JsonMember* section = FindMember(object_, spec.section)) {
    const auto* fields = section->value.As<JsonObject>();
    if (fields == nullptr) return;  // a wrong type, which has been noted
    const auto given = [fields](std::string_view name) {
      const JsonMember* field = FindMember(*fields, name);
      if (field == nullptr) return false;
      const auto* field_text = field->value.As<std::string>();
      const auto* items = field->value.As<JsonArray>();
      return !(field_text && field_text->empty()) && !(items && items->empty());
    };
    if (std::any_of(spec.fields.begin(), spec.fields.end(), given)) return;
  }
  mistakes_.Add(choice->value.place, Pointer(spec.section), "needed",
                fmt::format("{} {} needs {} or {} in {}", spec.choice, Quote(spec.value),
                            Quote(spec.fields[0]), Quote(spec.fields[1]), Pointer(spec.section)));
}

void ObjectReader::Require(std::string_view name, std::string_view example) {
  if (FindMember(object_, name) != nullptr) return;
  mistakes_.Add(place_, Pointer(name), "missing-key",
                fmt::format("missing; every scenario has {}", example));
}

void ObjectReader::RefuseUnknownKeys() {
  for (const JsonMember& member : object_) {
    if (mistakes_.full()) return;
    if (std::find(known_.begin(), known_.end(), member.key) != known_.end()) continue;
    mistakes_.Add(member.place, Pointer(member.key), "unknown-key", UnknownKeyMessage(member.key));
  }
}

std::string ObjectReader::UnknownKeyMessage(std::string_view key) const {
  constexpr std::size_t kMaxListed = 8;
  std::optional<std::string_view> meant = Nearest(key, known_);
  if (!meant) meant = FindName(key);
  if (meant) return "unknown key" + DidYouMean(meant);
  if (known_.size() <= kMaxListed) return "unknown key; known here are " + Names(known_);
  return "unknown key; known here: fogline check --explain " + NearestKnownPointer(pointer_);
}

}  // namespace

Scenario ReadScenario(const JsonValue& root, DiagnosticList& mistakes) {
  Scenario scenario;
  const auto* object = root.As<JsonObject>();
  if (object == nullptr) {
    mistakes.Add(root.place, "", "type", "a scenario must be an object, not " + Describe(root));
    return scenario;
  }
  ObjectReader reader(*object, root.place, "", mistakes);
  std::string schema;  // for editors; says nothing about the experiment
  reader.Text("$schema", schema, "");
  Scenario::Fields(scenario, reader);
  reader.Require("version", "\"version\": 1");
  reader.RefuseUnknownKeys();
  return scenario;
}

}  // namespace fogline
