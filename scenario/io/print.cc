// PrintScenario: writes every field as JSON.
#include <cstddef>
#include <string>
#include <utility>
#include <variant>

#include "common/text.h"
#include "scenario/io/loader.h"
#include "scenario/sections/field_view.h"

namespace fogline {
namespace {

constexpr std::size_t kMaxColumns = 100;

// Writes values. Each level inside a list or an object is indented by two more spaces.
class Printer {
 public:
  void operator()(const NumberField& number) { out_ += NumberText(*number.value); }
  void operator()(const IntegerField& integer) { out_ += std::to_string(*integer.value); }
  void operator()(const bool* flag) { out_ += *flag ? "true" : "false"; }
  void operator()(const std::string* text) { out_ += Quote(*text); }
  void operator()(const ChoiceField& choice) { out_ += Quote(choice.names[choice.get()]); }
  void operator()(const NumbersField& numbers);
  void operator()(const TextsField& texts) {
    out_ += '[';
    for (const std::string& text : *texts.values) {
      if (&text != &texts.values->front()) out_ += ", ";
      out_ += Quote(text);
    }
    out_ += ']';
  }
  void operator()(const ListField& list) { Block('[', list.items(""), ']'); }
  void operator()(const SectionField& section) { Block('{', section.fields(""), '}'); }

  void Block(char open, const FieldList& fields, char close) {
    out_ += open;
    ++depth_;
    for (const Field& field : fields) {
      if (&field != &fields.front()) out_ += ',';
      NewLine();
      if (!field.name.empty()) out_ += Quote(field.name) + ": ";
      std::visit(*this, field.value);
    }
    --depth_;
    if (!fields.empty()) NewLine();
    out_ += close;
  }

  std::string TakeText() { return std::move(out_); }

 private:
  // Begins a line; returns the offset of this line in `out_`.
  std::size_t NewLine() {
    out_ += '\n';
    const std::size_t begin = out_.size();
    out_.append(2 * depth_, ' ');
    return begin;
  }

  std::string out_;
  std::size_t depth_ = 0;
};

// Puts as many numbers into each line as fit.
void Printer::operator()(const NumbersField& numbers) {
  out_ += '[';
  ++depth_;
  std::size_t line_begin = 0;
  for (const double& value : *numbers.values) {
    const std::string number = NumberText(value);
    const bool first = &value == &numbers.values->front();
    if (first || out_.size() - line_begin + number.size() + 2 > kMaxColumns) {
      if (!first) out_ += ',';
      line_begin = NewLine();
    } else {
      out_ += ", ";
    }
    out_ += number;
  }
  --depth_;
  if (!numbers.values->empty()) NewLine();
  out_ += ']';
}

}  // namespace

std::string PrintScenario(const Scenario& scenario) {
  Scenario printed = scenario;  // FieldsOf() needs a scenario that is not const
  Printer printer;
  printer.Block('{', FieldsOf(printed), '}');
  return printer.TakeText() + "\n";
}

}  // namespace fogline
