#include "scenario/io/catalogue.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/sections/field_text.h"
#include "scenario/sections/scenario.h"

namespace fogline {
namespace {

// Visits a default scenario and notes each field.
class CatalogueBuilder {
 public:
  CatalogueBuilder(std::vector<FieldInfo>& infos, std::string pointer)
      : infos_(infos), pointer_(std::move(pointer)) {}

  void Number(std::string_view name, const double& value, const NumberSpec& spec) {
    Add(name, Allowed(spec), WithUnit(NumberText(value), spec.unit), spec.doc).source = spec.source;
  }
  void Integer(std::string_view name, const std::int64_t& value, const IntegerSpec& spec) {
    Add(name, Allowed(spec), WithUnit(std::to_string(value), spec.unit), spec.doc).source =
        spec.source;
  }
  void Flag(std::string_view name, const bool& value, std::string_view doc) {
    Add(name, "true or false", value ? "true" : "false", doc);
  }
  void Text(std::string_view name, const std::string& value, std::string_view doc) {
    Add(name, AllowedText(), Quote(value), doc);
  }
  template <class Enum>
  void Choice(std::string_view name, const Enum& value, std::string_view doc) {
    const std::span<const std::string_view> names = ChoiceNames<Enum>::kNames;
    FieldInfo& info = Add(name, Names(names), Quote(names[static_cast<std::size_t>(value)]), doc);
    info.choices = names;
    info.choice_docs = ChoiceNames<Enum>::kDocs;
  }
  void Numbers(std::string_view name, const std::vector<double>&, const NumberSpec& spec,
               const ListSpec& list) {
    Add(name, fmt::format("a list of {} numbers", Range(list)), "[]", spec.doc).source =
        spec.source;
    CatalogueBuilder(infos_, Pointer(name)).Add("*", Allowed(spec), "", spec.doc).source =
        spec.source;
  }
  template <class T>
  void Section(std::string_view name, const T& section, std::string_view doc) {
    Add(name, "an object", "", doc).is_section = true;
    CatalogueBuilder inner(infos_, Pointer(name));
    T::Fields(section, inner);
  }
  template <class T>
  void List(std::string_view name, const std::vector<T>&, const ListSpec& list) {
    Add(name, fmt::format("a list of {} objects", Range(list)), "[]", list.doc);
    CatalogueBuilder(infos_, Pointer(name)).Section("*", T{}, "An item of the list.");
  }
  void Needs(const NeedSpec& spec) {
    const auto info = std::find_if(infos_.begin(), infos_.end(), [&](const FieldInfo& candidate) {
      return candidate.pointer == Pointer(spec.section);
    });
    info->doc += fmt::format(" Needed with {} or {} where {} is {}.", spec.fields[0],
                             spec.fields[1], spec.choice, Quote(spec.value));
  }

 private:
  std::string Pointer(std::string_view name) const { return fmt::format("{}/{}", pointer_, name); }

  FieldInfo& Add(std::string_view name, std::string allowed, std::string default_text,
                 std::string_view doc) {
    return infos_.emplace_back(FieldInfo{.pointer = Pointer(name),
                                         .is_section = false,
                                         .allowed = std::move(allowed),
                                         .default_text = std::move(default_text),
                                         .doc = std::string(doc),
                                         .source = "",
                                         .choices = {},
                                         .choice_docs = {}});
  }

  std::vector<FieldInfo>& infos_;
  std::string pointer_;
};

std::vector<FieldInfo> BuildCatalogue() {
  std::vector<FieldInfo> infos{{.pointer = "/",
                                .is_section = true,
                                .allowed = "an object",
                                .default_text = "",
                                .doc = "A scenario.",
                                .source = "",
                                .choices = {},
                                .choice_docs = {}}};
  CatalogueBuilder builder(infos, "");
  const Scenario defaults;
  Scenario::Fields(defaults, builder);
  return infos;
}

// The segments of a pointer, each with its slash.
std::vector<std::string_view> Segments(std::string_view pointer) {
  std::vector<std::string_view> segments;
  while (!pointer.empty()) {
    segments.push_back(pointer.substr(0, pointer.find('/', 1)));
    pointer.remove_prefix(segments.back().size());
  }
  return segments;
}

bool IsIndex(std::string_view segment) { return !segment.empty() && ListIndex(segment.substr(1)); }

// `pointer` with * in place of each index.
std::string WithoutIndices(std::string_view pointer) {
  std::string out;
  for (const std::string_view segment : Segments(pointer)) out += IsIndex(segment) ? "/*" : segment;
  return out;
}

// `pattern` with the index of `pointer` at the same depth in place of each *.
std::string WithIndicesOf(std::string_view pointer, std::string_view pattern) {
  const std::vector<std::string_view> segments = Segments(pointer);
  std::string out;
  std::size_t depth = 0;
  for (const std::string_view segment : Segments(pattern)) {
    const bool index = segment == "/*" && depth < segments.size() && IsIndex(segments[depth]);
    out += index ? segments[depth] : segment;
    ++depth;
  }
  return out;
}

}  // namespace

std::optional<std::size_t> ListIndex(std::string_view segment) {
  if (segment.size() > 1 && segment.front() == '0') return std::nullopt;
  std::size_t index = 0;
  const char* const last = segment.data() + segment.size();
  const auto [end, error] = std::from_chars(segment.data(), last, index);
  if (end != last || error == std::errc::invalid_argument) return std::nullopt;
  // A number too large for size_t is an index, too; no list has such an item.
  return error == std::errc() ? index : std::numeric_limits<std::size_t>::max();
}

const std::vector<FieldInfo>& Catalogue() {
  static const std::vector<FieldInfo> catalogue = BuildCatalogue();
  return catalogue;
}

const FieldInfo* FindField(std::string_view pointer) {
  const std::string wanted = pointer.empty() ? "/" : WithoutIndices(pointer);
  const auto& catalogue = Catalogue();
  const auto it = std::find_if(catalogue.begin(), catalogue.end(),
                               [&](const FieldInfo& info) { return info.pointer == wanted; });
  return it == catalogue.end() ? nullptr : &*it;
}

std::string NearestKnownPointer(std::string_view pointer) {
  while (!pointer.empty() && FindField(pointer) == nullptr) {
    pointer = pointer.substr(0, std::min(pointer.rfind('/'), pointer.size() - 1));
  }
  return pointer.empty() ? "/" : std::string(pointer);
}

std::optional<std::string_view> FindName(std::string_view name) {
  for (const FieldInfo& info : Catalogue()) {
    const std::string_view pointer = info.pointer;
    if (pointer != "/" && pointer.find('*') == std::string_view::npos &&
        pointer.substr(pointer.rfind('/') + 1) == name) {
      return pointer;
    }
  }
  return std::nullopt;
}

std::optional<std::string> SuggestPointer(std::string_view pointer) {
  std::vector<std::string_view> pointers;
  for (const FieldInfo& info : Catalogue()) pointers.emplace_back(info.pointer);
  if (const auto alike = Nearest(WithoutIndices(pointer), pointers)) {
    return WithIndicesOf(pointer, *alike);
  }
  const auto same = FindName(pointer.substr(pointer.rfind('/') + 1));
  return same ? std::optional<std::string>(*same) : std::nullopt;
}

}  // namespace fogline
