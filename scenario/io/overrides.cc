#include "scenario/io/overrides.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/catalogue.h"

namespace fogline {
namespace {

constexpr std::string_view kExample = "must be /pointer=value, such as /arbitrator/threshold=0.8";

// A hint for an override without the slash at its beginning, or with dots: for "fog/model=beam" and
// "fog.model=beam" the hint suggests "/fog/model". "" if there is no such field.
std::string FormHint(std::string_view text) {
  std::string pointer = fmt::format("/{}", text.substr(0, text.find('=')));
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  return FindField(pointer) == nullptr ? "" : DidYouMean(pointer);
}

// The value as JSON, or as plain text if it is not JSON. Returns nothing if ParseJson() refuses the
// value for a reason other than its syntax, such as its size.
std::optional<JsonValue> ParseValue(std::string_view text, std::uint32_t source,
                                    std::string_view pointer, DiagnosticList& mistakes) {
  DiagnosticList trial;
  if (!ParseJson(text, source, trial) && trial.Has("syntax")) {
    return JsonValue{.data = std::string(text), .place = {.source = source, .offset = 0}};
  }
  return ParseJson(text, source, mistakes, pointer);
}

bool IsList(std::string_view pointer) { return FindField(std::string(pointer) + "/*") != nullptr; }

// The item with the index `segment`, or null.
JsonValue* FindItem(JsonArray& items, std::string_view segment) {
  const auto index = ListIndex(segment);
  return index && *index < items.size() ? &items[*index] : nullptr;
}

// The value at `pointer`, which names a known field. Adds missing sections of the path. If a list
// lacks an item of the path, the function notes this mistake and returns null. If a section of the
// path has a value of a wrong type, the function returns null, and ReadScenario() notes this
// mistake.
JsonValue* Walk(JsonValue& root, std::string_view pointer, Place place, DiagnosticList& mistakes) {
  JsonValue* at = &root;
  std::size_t begin = 0;
  while (at != nullptr && begin < pointer.size()) {
    const std::size_t end = std::min(pointer.find('/', begin + 1), pointer.size());
    const std::string_view above = pointer.substr(0, begin);
    const std::string_view segment = pointer.substr(begin + 1, end - begin - 1);
    if (IsList(above)) {
      auto* items = at->As<JsonArray>();
      at = items ? FindItem(*items, segment) : nullptr;
      if (items && !at) {
        mistakes.Add(
            place, std::string(pointer), "override",
            fmt::format("no such item: {} has {} items, counted from 0", above, items->size()));
      }
    } else if (auto* object = at->As<JsonObject>()) {
      JsonMember* member = FindMember(*object, segment);
      if (member == nullptr) {
        JsonValue empty{.data = JsonObject{}, .place = place};
        if (IsList(pointer.substr(0, end))) empty.data = JsonArray{};
        member = &object->emplace_back(
            JsonMember{.key = std::string(segment), .place = place, .value = std::move(empty)});
      }
      at = &member->value;
    } else {
      at = nullptr;
    }
    begin = end;
  }
  return at;
}

}  // namespace

void ApplyOverride(std::string_view text, std::uint32_t source, JsonValue& root,
                   DiagnosticList& mistakes) {
  const Place place{.source = source, .offset = 0};
  const std::size_t equals = text.find('=');
  if (!IsUtf8(text) || !text.starts_with('/') || equals == std::string_view::npos || equals < 2) {
    mistakes.Add(place, "", "override", std::string(kExample) + FormHint(text));
    return;
  }
  const std::string_view pointer = text.substr(0, equals);
  if (FindField(pointer) == nullptr) {
    mistakes.Add(place, std::string(pointer), "override",
                 "no such field" + DidYouMean(SuggestPointer(pointer)));
    return;
  }
  std::optional<JsonValue> value = ParseValue(text.substr(equals + 1), source, pointer, mistakes);
  if (!value) return;
  if (JsonValue* at = Walk(root, pointer, place, mistakes)) *at = *std::move(value);
}

}  // namespace fogline
