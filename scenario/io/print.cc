// PrintScenario: a visitor that writes every field.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/text.h"
#include "scenario/io/loader.h"

namespace fogline {
namespace {

constexpr std::size_t kMaxColumns = 100;

// Writes the members of one object, indented by two spaces a level.
class Printer {
 public:
  Printer(std::string& out, std::size_t depth) : out_(out), depth_(depth) {}

  void Number(std::string_view name, const double& value, const NumberSpec&) {
    Key(name);
    out_ += NumberText(value);
  }
  void Integer(std::string_view name, const std::int64_t& value, const IntegerSpec&) {
    Key(name);
    out_ += std::to_string(value);
  }
  void Flag(std::string_view name, const bool& value, std::string_view /*doc*/) {
    Key(name);
    out_ += value ? "true" : "false";
  }
  void Text(std::string_view name, const std::string& value, std::string_view /*doc*/) {
    Key(name);
    out_ += Quote(value);
  }
  template <class Enum>
  void Choice(std::string_view name, const Enum& value, std::string_view /*doc*/) {
    Key(name);
    out_ += Quote(ChoiceNames<Enum>::kNames[static_cast<std::size_t>(value)]);
  }
  void Numbers(std::string_view name, const std::vector<double>& values, const NumberSpec&,
               const ListSpec&) {
    Key(name);
    out_ += '[';
    std::size_t line_begin = out_.size();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string number = NumberText(values[i]);
      const bool full = out_.size() - line_begin + number.size() + 2 > kMaxColumns;
      if (i == 0 || full) {
        if (i > 0) out_ += ',';
        line_begin = NewLine(depth_ + 1);
      } else {
        out_ += ", ";
      }
      out_ += number;
    }
    if (!values.empty()) NewLine(depth_);
    out_ += ']';
  }
  template <class T>
  void Section(std::string_view name, const T& section, std::string_view /*doc*/) {
    Key(name);
    Object(section, depth_);
  }
  template <class T>
  void List(std::string_view name, const std::vector<T>& items, const ListSpec&) {
    Key(name);
    out_ += '[';
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (i > 0) out_ += ',';
      NewLine(depth_ + 1);
      Object(items[i], depth_ + 1);
    }
    if (!items.empty()) NewLine(depth_);
    out_ += ']';
  }
  void Needs(const NeedSpec&) {}

  // Writes `object` in braces that are indented by `depth` levels.
  template <class T>
  void Object(const T& object, std::size_t depth) {
    out_ += '{';
    Printer inner(out_, depth + 1);
    T::Fields(object, inner);
    NewLine(depth);
    out_ += '}';
  }

 private:
  // Begins a line; returns where in `out_` it begins.
  std::size_t NewLine(std::size_t depth) {
    out_ += '\n';
    const std::size_t begin = out_.size();
    out_.append(2 * depth, ' ');
    return begin;
  }
  void Key(std::string_view name) {
    if (!first_) out_ += ',';
    first_ = false;
    NewLine(depth_);
    out_ += Quote(name);
    out_ += ": ";
  }

  std::string& out_;
  std::size_t depth_;
  bool first_ = true;
};

}  // namespace

std::string PrintScenario(const Scenario& scenario) {
  std::string out;
  Printer(out, 0).Object(scenario, 0);
  out += '\n';
  return out;
}

}  // namespace fogline
