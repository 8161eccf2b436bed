#include "scenario/io/assignment.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <span>

#include <fmt/core.h>

#include "common/errors.h"
#include "scenario/io/catalogue.h"

namespace fogline {
namespace {

/// A value in both forms that fields take: as text, and as number if the text is one.
struct Value {
  std::optional<double> number;
  std::string_view text;
};

/// Follows a path through the sections and sets the field at its end.
class Assigner {
 public:
  Assigner(std::span<const std::string> path, const Value& value) : path_(path), value_(value) {}

  bool done() const { return done_; }

  void Number(std::string_view name, double& field, const NumberSpec&) {
    if (Here(name) && value_.number) Done(field = *value_.number);
  }
  void Integer(std::string_view name, std::int64_t& field, const IntegerSpec&) {
    if (Here(name) && value_.number) Done(field = std::llround(*value_.number));
  }
  void Flag(std::string_view name, bool& field, std::string_view) {
    if (Here(name) && (value_.text == "true" || value_.text == "false")) {
      Done(field = value_.text == "true");
    }
  }
  template <class Enum>
  void Choice(std::string_view name, Enum& field, std::string_view) {
    if (!Here(name)) return;
    for (std::size_t i = 0; i < ChoiceNames<Enum>::kNames.size(); ++i) {
      if (ChoiceNames<Enum>::kNames[i] == value_.text) Done(field = static_cast<Enum>(i));
    }
  }
  template <class S>
  void Section(std::string_view name, S& section, std::string_view) {
    if (path_.size() < 2 || path_.front() != name) return;
    Assigner inner(path_.subspan(1), value_);
    S::Fields(section, inner);
    done_ = done_ || inner.done_;
  }
  void Text(std::string_view, std::string&, std::string_view) {}
  void Numbers(std::string_view name, std::vector<double>& list, const NumberSpec&,
               const ListSpec&) {
    double* const item = path_.size() == 2 ? ItemOf(name, list) : nullptr;
    if (item != nullptr && value_.number) Done(*item = *value_.number);
  }
  template <class Item>
  void List(std::string_view name, std::vector<Item>& list, const ListSpec&) {
    Item* const item = path_.size() > 2 ? ItemOf(name, list) : nullptr;
    if (item == nullptr) return;
    Assigner inner(path_.subspan(2), value_);
    Item::Fields(*item, inner);
    done_ = done_ || inner.done_;
  }

  void Needs(const NeedSpec&) {}

 private:
  bool Here(std::string_view name) const { return path_.size() == 1 && path_.front() == name; }
  /// The item of the list to which the path leads; nullptr if the path leads to another field or
  /// the list has no such item.
  template <class Item>
  Item* ItemOf(std::string_view name, std::vector<Item>& list) const {
    if (path_.front() != name) return nullptr;
    const auto index = ListIndex(path_[1]);
    return index && *index < list.size() ? &list[*index] : nullptr;
  }
  template <class T>
  void Done(const T&) {
    done_ = true;
  }

  std::span<const std::string> path_;
  const Value& value_;
  bool done_ = false;
};

void Assign(Scenario& scenario, std::span<const std::string> path, const std::string& pointer,
            const Value& value) {
  Assigner assigner(path, value);
  Scenario::Fields(scenario, assigner);
  if (!assigner.done()) {
    throw InputError(fmt::format("error: {} cannot be \"{}\"", pointer, value.text));
  }
}

}  // namespace

FieldAssignment::FieldAssignment(std::string_view pointer) : pointer_(pointer) {
  const FieldInfo* field = FindField(pointer);
  if (field == nullptr || field->is_section) {
    const auto suggestion = SuggestPointer(pointer);
    throw InputError(fmt::format("error: {}: no field of a scenario{}", pointer,
                                 suggestion ? fmt::format("; did you mean {}?", *suggestion) : ""));
  }
  for (std::string_view rest = pointer.substr(1); !rest.empty();) {
    const std::size_t end = std::min(rest.find('/'), rest.size());
    path_.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

void FieldAssignment::Set(Scenario& scenario, double number) const {
  Assign(scenario, path_, pointer_, {.number = number, .text = ""});
}

void FieldAssignment::Set(Scenario& scenario, std::string_view text) const {
  Value value{.number = std::nullopt, .text = text};
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size()) value.number = number;
  Assign(scenario, path_, pointer_, value);
}

}  // namespace fogline
