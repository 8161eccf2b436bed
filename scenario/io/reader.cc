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
#include <variant>
#include <vector>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/catalogue.h"
#include "scenario/sections/field_text.h"
#include "scenario/sections/field_view.h"

namespace fogline {
namespace {

std::optional<double> ToNumber(const JsonValue& value) {
  if (const auto* integer = value.As<std::int64_t>()) return static_cast<double>(*integer);
  if (const auto* number = value.As<double>()) return *number;
  return std::nullopt;
}

// The value as an integer, if it is one. Both 3 and 3.0 are integers, as in JSON schema. A number
// beyond int64 becomes the nearest limit of int64, which is outside the range of every field.
std::optional<std::int64_t> ToInteger(const JsonValue& value) {
  if (const auto* integer = value.As<std::int64_t>()) return *integer;
  const auto* number = value.As<double>();
  if (number == nullptr || std::trunc(*number) != *number) return std::nullopt;
  constexpr double kLimit = 0x1p63;
  if (*number >= kLimit) return std::numeric_limits<std::int64_t>::max();
  if (*number < -kLimit) return std::numeric_limits<std::int64_t>::min();
  return static_cast<std::int64_t>(*number);
}

// The number, approximately as written in the file. @pre ToNumber(value)
std::string TextOfNumber(const JsonValue& value) {
  if (const auto* integer = value.As<std::int64_t>()) return std::to_string(*integer);
  return NumberText(*ToNumber(value));
}

// A hint for a value of the wrong type. If the value is a text that would be a number or a boolean
// without its quotes, the hint asks whether the quotes are a mistake. Otherwise the hint is "".
std::string_view QuotesHint(const JsonValue& value) {
  const auto* text = value.As<std::string>();
  if (text == nullptr) return "";
  DiagnosticList ignored;
  const std::optional<JsonValue> inner = ParseJson(*text, 0, ignored);
  const bool bare = inner && (ToNumber(*inner) || inner->As<bool>() != nullptr);
  return bare ? "; did you mean it without quotes?" : "";
}

std::vector<std::string_view> KeysOf(const FieldList& fields) {
  std::vector<std::string_view> keys;
  for (const Field& field : fields) keys.push_back(field.name);
  return keys;
}

// Reads values into fields, and notes each mistake at its pointer.
class Reader {
 public:
  /// Where the reader looks for the name that the user may have meant by an unknown key: in the
  /// whole scenario (kScenario), or only in the same section (kNone).
  enum class Hints { kScenario, kNone };

  explicit Reader(DiagnosticList& mistakes, Hints hints = Hints::kScenario)
      : mistakes_(mistakes), hints_(hints) {}

  // Reads those members of an object that are fields.
  void ReadFields(const JsonObject& object, const FieldList& fields);
  // Refuses members that are not fields. `known` has the names of the fields.
  void RefuseUnknownKeys(const JsonObject& object, const std::string& pointer,
                         const std::vector<std::string_view>& known);

  void Read(const JsonValue& value, const std::string& pointer, const NumberField& number);
  void Read(const JsonValue& value, const std::string& pointer, const IntegerField& integer);
  void Read(const JsonValue& value, const std::string& pointer, bool* flag);
  void Read(const JsonValue& value, const std::string& pointer, std::string* text);
  void Read(const JsonValue& value, const std::string& pointer, const ChoiceField& choice);
  void Read(const JsonValue& value, const std::string& pointer, const NumbersField& numbers);
  void Read(const JsonValue& value, const std::string& pointer, const TextsField& texts);
  void Read(const JsonValue& value, const std::string& pointer, const ListField& list);
  void Read(const JsonValue& value, const std::string& pointer, const SectionField& section);

 private:
  void CheckNeed(const JsonObject& object, const Field& section, const NeedSpec& need);
  // The items of a list; null if the value is not a list or has a wrong length.
  const JsonArray* Items(const JsonValue& value, const std::string& pointer, const ListSpec& list);

  // Notes a wrong type.
  void Refuse(const JsonValue& value, const std::string& pointer, std::string_view allowed,
              std::string_view hint = "") {
    mistakes_.Add(value.place, pointer, "type",
                  fmt::format("must be {}, not {}{}", allowed, Describe(value), hint));
  }

  DiagnosticList& mistakes_;
  Hints hints_;
};

void Reader::Read(const JsonValue& value, const std::string& pointer, const NumberField& number) {
  const NumberSpec& spec = number.spec;
  const std::optional<double> read = ToNumber(value);
  if (!read) return Refuse(value, pointer, Allowed(spec), QuotesHint(value));
  if (*read < spec.min || *read > spec.max) {
    return mistakes_.Add(value.place, pointer, "range",
                         fmt::format("{} is outside {}", TextOfNumber(value), Range(spec)));
  }
  *number.value = *read;
}

void Reader::Read(const JsonValue& value, const std::string& pointer, const IntegerField& integer) {
  const IntegerSpec& spec = integer.spec;
  const std::optional<std::int64_t> read = ToInteger(value);
  if (!read) return Refuse(value, pointer, Allowed(spec), QuotesHint(value));
  if (*read < spec.min || *read > spec.max) {
    const std::string number = TextOfNumber(value);
    return mistakes_.Add(value.place, pointer, "range",
                         spec.min == spec.max
                             ? fmt::format("must be {}, not {}", Allowed(spec), number)
                             : fmt::format("{} is outside {}", number, Range(spec)));
  }
  *integer.value = *read;
}

void Reader::Read(const JsonValue& value, const std::string& pointer, bool* flag) {
  const auto* read = value.As<bool>();
  if (read == nullptr) return Refuse(value, pointer, "true or false", QuotesHint(value));
  *flag = *read;
}

void Reader::Read(const JsonValue& value, const std::string& pointer, std::string* text) {
  const auto* read = value.As<std::string>();
  if (read == nullptr) return Refuse(value, pointer, "a text");
  const std::size_t length = CountCharacters(*read);
  if (length > static_cast<std::size_t>(kMaxTextLength)) {
    mistakes_.Add(value.place, pointer, "text",
                  fmt::format("{} characters; allowed are {}", length, kMaxTextLength));
  } else if (HasControlCharacter(*read)) {
    mistakes_.Add(value.place, pointer, "text",
                  fmt::format("a control character, which is not allowed: {}", QuoteShort(*read)));
  } else {
    *text = *read;
  }
}

void Reader::Read(const JsonValue& value, const std::string& pointer, const ChoiceField& choice) {
  const auto* text = value.As<std::string>();
  if (text == nullptr) return Refuse(value, pointer, "one of " + Names(choice.names));
  const auto it = std::find(choice.names.begin(), choice.names.end(), *text);
  if (it == choice.names.end()) {
    return mistakes_.Add(
        value.place, pointer, "choice",
        fmt::format("{} is not one of {}{}", QuoteShort(*text), Names(choice.names),
                    DidYouMean(Nearest(*text, choice.names))));
  }
  choice.set(static_cast<std::size_t>(it - choice.names.begin()));
}

const JsonArray* Reader::Items(const JsonValue& value, const std::string& pointer,
                               const ListSpec& list) {
  const auto* items = value.As<JsonArray>();
  if (items == nullptr) {
    Refuse(value, pointer, fmt::format("a list of {} items", Range(list)));
    return nullptr;
  }
  const auto count = static_cast<std::int64_t>(items->size());
  if (count >= list.min_items && count <= list.max_items) return items;
  mistakes_.Add(value.place, pointer, "list-length",
                fmt::format("{} items; allowed are {}", count, Range(list)));
  return nullptr;
}

void Reader::Read(const JsonValue& value, const std::string& pointer, const NumbersField& numbers) {
  const JsonArray* items = Items(value, pointer, numbers.list);
  if (items == nullptr) return;
  const NumberSpec& spec = numbers.spec;
  numbers.values->assign(items->size(), 0.0);
  for (std::size_t i = 0; i < items->size() && !mistakes_.full(); ++i) {
    const JsonValue& item = (*items)[i];
    double& number = (*numbers.values)[i];
    if (const std::optional<double> n = ToNumber(item); n && *n >= spec.min && *n <= spec.max) {
      number = *n;
    } else {
      Read(item, fmt::format("{}/{}", pointer, i), NumberField{.value = &number, .spec = spec});
    }
  }
}

void Reader::Read(const JsonValue& value, const std::string& pointer, const TextsField& texts) {
  const JsonArray* items = Items(value, pointer, texts.list);
  if (items == nullptr) return;
  texts.values->assign(items->size(), "");
  for (std::size_t i = 0; i < items->size(); ++i) {
    Read((*items)[i], fmt::format("{}/{}", pointer, i), &(*texts.values)[i]);
  }
}

void Reader::Read(const JsonValue& value, const std::string& pointer, const ListField& list) {
  const JsonArray* items = Items(value, pointer, list.list);
  if (items == nullptr) return;
  list.reset(items->size());
  const FieldList fields = list.items(pointer);
  for (std::size_t i = 0; i < items->size(); ++i) {
    Read((*items)[i], fields[i].pointer, *fields[i].As<SectionField>());
  }
}

void Reader::Read(const JsonValue& value, const std::string& pointer, const SectionField& section) {
  const auto* object = value.As<JsonObject>();
  if (object == nullptr) return Refuse(value, pointer, "an object");
  const FieldList fields = section.fields(pointer);
  ReadFields(*object, fields);
  RefuseUnknownKeys(*object, pointer, KeysOf(fields));
}

void Reader::CheckNeed(const JsonObject& object, const Field& section, const NeedSpec& need) {
  const JsonMember* choice = FindMember(object, need.choice);
  if (choice == nullptr) return;
  const auto* text = choice->value.As<std::string>();
  if (text == nullptr || *text != need.value) return;
  if (const JsonMember* member = FindMember(object, section.name)) {
    const auto* fields = member->value.As<JsonObject>();
    if (fields == nullptr) return;  // Read() has noted this wrong type
    const auto given = [fields](std::string_view name) {
      const JsonMember* field = FindMember(*fields, name);
      if (field == nullptr) return false;
      const auto* field_text = field->value.As<std::string>();
      const auto* items = field->value.As<JsonArray>();
      return !(field_text && field_text->empty()) && !(items && items->empty());
    };
    if (std::any_of(need.fields.begin(), need.fields.end(), given)) return;
  }
  mistakes_.Add(choice->value.place, section.pointer, "needed",
                fmt::format("{} {} needs {} or {} in {}", need.choice, Quote(need.value),
                            Quote(need.fields[0]), Quote(need.fields[1]), section.pointer));
}

std::string UnknownKeyMessage(std::string_view key, const std::string& pointer,
                              std::span<const std::string_view> known) {
  constexpr std::size_t kMaxListed = 8;
  std::optional<std::string_view> meant = Nearest(key, known);
  if (!meant) meant = FindName(key);
  if (meant) return "unknown key" + DidYouMean(meant);
  if (known.size() <= kMaxListed) return "unknown key; known here are " + Names(known);
  return "unknown key; known here: fogline check --explain " + NearestKnownPointer(pointer);
}

void Reader::ReadFields(const JsonObject& object, const FieldList& fields) {
  for (const Field& field : fields) {
    if (const JsonMember* member = FindMember(object, field.name)) {
      std::visit([&](const auto& view) { Read(member->value, field.pointer, view); }, field.value);
    }
    const auto* section = field.As<SectionField>();
    if (section != nullptr && !section->need.choice.empty()) {
      CheckNeed(object, field, section->need);
    }
  }
}

void Reader::RefuseUnknownKeys(const JsonObject& object, const std::string& pointer,
                               const std::vector<std::string_view>& known) {
  for (const JsonMember& member : object) {
    if (mistakes_.full()) return;
    if (std::find(known.begin(), known.end(), member.key) != known.end()) continue;
    mistakes_.Add(member.place, JoinPointer(pointer, member.key), "unknown-key",
                  hints_ == Hints::kScenario
                      ? UnknownKeyMessage(member.key, pointer, known)
                      : fmt::format("unknown key{}; known here are {}",
                                    DidYouMean(Nearest(member.key, known)), Names(known)));
  }
}

// Reads a whole file: its fields and $schema. Notes a mistake if `version` is missing.
// @param what the kind of file with its article, such as "a scenario"
void ReadRoot(const JsonValue& root, const FieldList& fields, std::string_view what,
              Reader::Hints hints, DiagnosticList& mistakes) {
  const auto* object = root.As<JsonObject>();
  if (object == nullptr) {
    return mistakes.Add(root.place, "", "type",
                        fmt::format("{} must be an object, not {}", what, Describe(root)));
  }
  Reader reader(mistakes, hints);
  constexpr std::string_view kSchema = "$schema";
  std::string schema;  // only editors use it; it is not part of the experiment
  if (const JsonMember* member = FindMember(*object, kSchema)) {
    reader.Read(member->value, JoinPointer("", kSchema), &schema);
  }
  reader.ReadFields(*object, fields);
  if (FindMember(*object, "version") == nullptr) {
    mistakes.Add(
        root.place, "/version", "missing-key",
        fmt::format("missing; every {} has \"version\": 1", what.substr(what.find(' ') + 1)));
  }
  std::vector<std::string_view> known = KeysOf(fields);
  known.insert(known.begin(), kSchema);
  reader.RefuseUnknownKeys(*object, "", known);
}

}  // namespace

Scenario ReadScenario(const JsonValue& root, DiagnosticList& mistakes) {
  Scenario scenario;
  ReadRoot(root, FieldsOf(scenario), "a scenario", Reader::Hints::kScenario, mistakes);
  return scenario;
}

ExperimentPlan ReadExperiment(const JsonValue& root, DiagnosticList& mistakes) {
  ExperimentPlan plan;
  ReadRoot(root, FieldsOf(plan), "an experiment", Reader::Hints::kNone, mistakes);
  return plan;
}

LabPlan ReadLab(const JsonValue& root, DiagnosticList& mistakes) {
  LabPlan plan;
  ReadRoot(root, FieldsOf(plan), "a laboratory", Reader::Hints::kNone, mistakes);
  return plan;
}

}  // namespace fogline
