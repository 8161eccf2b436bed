#include "scenario/sections/field_view.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "scenario/sections/decision.h"

namespace fogline {
namespace {

template <class Section>
FieldList ListFields(Section& section, const std::string& pointer);

template <class Section>
SectionField ViewOf(Section& section, const NeedSpec& need = {}) {
  return {.need = need, .fields = [&section](const std::string& pointer) {
            return ListFields(section, pointer);
          }};
}

Field Item(const std::string& list, std::size_t index, std::string_view doc,
           std::string_view source, decltype(Field::value) value) {
  return {.pointer = fmt::format("{}/{}", list, index),
          .name = "",
          .doc = doc,
          .source = source,
          .value = std::move(value)};
}

// Collects the fields of one section. FOGLINE_FIELD calls operator() with the arguments of each
// field.
class FieldLister {
 public:
  explicit FieldLister(const std::string& pointer) : pointer_(pointer) {}

  FieldList TakeFields() { return std::move(fields_); }

  void operator()(std::string_view name, double& value, const NumberSpec& spec,
                  std::string_view doc, std::string_view source) {
    Add(name, doc, source, NumberField{.value = &value, .spec = spec});
  }
  void operator()(std::string_view name, std::int64_t& value, const IntegerSpec& spec,
                  std::string_view doc, std::string_view source) {
    Add(name, doc, source, IntegerField{.value = &value, .spec = spec});
  }
  void operator()(std::string_view name, bool& value, std::string_view doc) {
    Add(name, doc, "", &value);
  }
  void operator()(std::string_view name, std::string& value, std::string_view doc) {
    Add(name, doc, "", &value);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(std::string_view name, Enum& value, std::string_view doc) {
    Add(name, doc, "",
        ChoiceField{.names = ChoiceNames<Enum>::kNames,
                    .docs = ChoiceNames<Enum>::kDocs,
                    .get = [&value] { return static_cast<std::size_t>(value); },
                    .set = [&value](std::size_t index) { value = static_cast<Enum>(index); }});
  }
  template <class Section>
  requires std::is_class_v<Section>
  void operator()(std::string_view name, Section& section, std::string_view doc,
                  const NeedSpec& need = {}) {
    Add(name, doc, "", ViewOf(section, need));
  }
  void operator()(std::string_view name, std::vector<double>& values, const ListSpec& list,
                  const NumberSpec& spec, std::string_view doc, std::string_view source) {
    Add(name, doc, source, NumbersField{.values = &values, .list = list, .spec = spec});
  }
  void operator()(std::string_view name, std::vector<std::string>& values, const ListSpec& list,
                  std::string_view doc) {
    Add(name, doc, "", TextsField{.values = &values, .list = list});
  }
  template <class Section>
  void operator()(std::string_view name, std::vector<Section>& items, const ListSpec& list,
                  std::string_view doc) {
    const auto views = [&items](const std::string& pointer) {
      FieldList fields;
      for (Section& item : items) {
        fields.push_back(Item(pointer, fields.size(), "An item of the list.", "", ViewOf(item)));
      }
      return fields;
    };
    Add(name, doc, "",
        ListField{.list = list,
                  .reset = [&items](std::size_t size) { items.assign(size, Section{}); },
                  .items = views});
  }

 private:
  void Add(std::string_view name, std::string_view doc, std::string_view source,
           decltype(Field::value) value) {
    fields_.push_back({.pointer = fmt::format("{}/{}", pointer_, name),
                       .name = name,
                       .doc = doc,
                       .source = source,
                       .value = std::move(value)});
  }

  const std::string& pointer_;
  FieldList fields_;
};

template <class Section>
FieldList ListFields(Section& section, const std::string& pointer) {
  FieldLister lister(pointer);
  section.VisitFieldsUpTo(lister, SourceLine<kLastFieldLine>());
  return lister.TakeFields();
}

void AddWithContents(FieldList fields, FieldList& all) {
  for (Field& field : fields) {
    FieldList contents = field.Contents();
    all.push_back(std::move(field));
    AddWithContents(std::move(contents), all);
  }
}

FieldList WithContents(FieldList fields) {
  FieldList all;
  AddWithContents(std::move(fields), all);
  return all;
}

Field NumberAt(const Field& list, std::size_t index) {
  const auto* numbers = list.As<NumbersField>();
  return Item(list.pointer, index, list.doc, list.source,
              NumberField{.value = &(*numbers->values)[index], .spec = numbers->spec});
}

}  // namespace

FieldList Field::Contents() const {
  if (const auto* section = As<SectionField>()) return section->fields(pointer);
  if (const auto* sections = As<ListField>()) return sections->items(pointer);
  const auto* numbers = As<NumbersField>();
  FieldList items;
  const auto* texts = As<TextsField>();
  for (std::size_t i = 0; texts != nullptr && i < texts->values->size(); ++i) {
    items.push_back(Item(pointer, i, doc, "", &(*texts->values)[i]));
  }
  while (numbers != nullptr && items.size() < numbers->values->size()) {
    items.push_back(NumberAt(*this, items.size()));
  }
  return items;
}

FieldList FieldsOf(Scenario& scenario) { return ListFields(scenario, ""); }
FieldList FieldsOf(ExperimentPlan& plan) { return ListFields(plan, ""); }
FieldList FieldsOf(LabPlan& plan) { return ListFields(plan, ""); }

FieldList FieldsOf(PublishedRow& row, const std::string& pointer) {
  return ListFields(row, pointer);
}

FieldList AllFields(Scenario& scenario) { return WithContents(FieldsOf(scenario)); }
FieldList AllFields(ExperimentPlan& plan) { return WithContents(FieldsOf(plan)); }
FieldList AllFields(LabPlan& plan) { return WithContents(FieldsOf(plan)); }

std::optional<std::size_t> ListIndex(std::string_view segment) {
  if (segment.size() > 1 && segment.front() == '0') return std::nullopt;
  std::size_t index = 0;
  const char* const last = segment.data() + segment.size();
  const auto [end, error] = std::from_chars(segment.data(), last, index);
  if (end != last || error == std::errc::invalid_argument) return std::nullopt;
  // A number too large for size_t is a valid index, too. The result is then the largest size_t, at
  // which no list has an item.
  return error == std::errc() ? index : std::numeric_limits<std::size_t>::max();
}

std::optional<Field> FieldAt(Scenario& scenario, std::string_view pointer) {
  FieldList fields = FieldsOf(scenario);
  const auto on_the_way = [pointer](const Field& field) {
    return pointer == field.pointer || pointer.starts_with(field.pointer + "/");
  };
  for (;;) {
    const auto field = std::find_if(fields.begin(), fields.end(), on_the_way);
    if (field == fields.end()) return std::nullopt;
    if (field->pointer == pointer) return std::move(*field);
    // For a list of a million numbers, this branch is faster than Contents().
    if (const auto* numbers = field->As<NumbersField>()) {
      const auto index = ListIndex(pointer.substr(field->pointer.size() + 1));
      if (!index || *index >= numbers->values->size()) return std::nullopt;
      return NumberAt(*field, *index);
    }
    fields = field->Contents();
  }
}

}  // namespace fogline
