#include "scenario/io/diagnostic_list.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "common/text.h"
#include "scenario/io/catalogue.h"

namespace fogline {
namespace {

constexpr std::size_t kMaxPrinted = 20;

// Finds the line and the column of offsets in a text. The offsets must come in ascending order, so
// that one pass over the text is enough.
class LineCounter {
 public:
  explicit LineCounter(std::string_view text) : text_(text), at_(SkipByteOrderMark(text)) {}

  void AdvanceTo(std::size_t offset) {
    for (; at_ < std::min(offset, text_.size()); ++at_) {
      if (text_[at_] == '\n') {
        ++line_;
        column_ = 1;
      } else if (!IsContinuation(text_[at_])) {
        ++column_;
      }
    }
  }
  int line() const { return line_; }
  int column() const { return column_; }

 private:
  // Whether the byte continues a UTF-8 character.
  static bool IsContinuation(char byte) { return (static_cast<unsigned char>(byte) >> 6U) == 2; }

  std::string_view text_;
  std::size_t at_;
  int line_ = 1;
  int column_ = 1;
};

std::string Line(const Diagnostic& mistake) {
  std::string line = EscapeControls(mistake.file);
  if (mistake.line > 0) line += fmt::format(":{}:{}", mistake.line, mistake.column);
  line += ": error: ";
  if (!mistake.pointer.empty()) line += Shown(mistake.pointer) + ": ";
  return line + mistake.message + "\n";
}

std::string Text(const std::vector<Diagnostic>& mistakes, std::string_view or_more,
                 std::string_view allowed) {
  std::string text;
  const std::size_t printed = std::min(mistakes.size(), kMaxPrinted);
  for (std::size_t i = 0; i < printed; ++i) text += Line(mistakes[i]);
  if (mistakes.size() > printed) {
    text += fmt::format("... and {}{}\n", mistakes.size() - printed,
                        or_more.empty() ? " more" : or_more);
  }
  return text + fmt::format("{}{} error{}; what is allowed: {}", mistakes.size(), or_more,
                            mistakes.size() == 1 ? "" : "s",
                            allowed.empty() ? "fogline check --explain " +
                                                  NearestKnownPointer(mistakes[0].pointer)
                                            : std::string(allowed));
}

}  // namespace

void DiagnosticList::Add(Place place, std::string pointer, std::string_view rule,
                         std::string message) {
  if (full()) return;
  kept_.push_back({.place = place,
                   .mistake = {.file = "",
                               .line = 0,
                               .column = 0,
                               .pointer = std::move(pointer),
                               .rule = std::string(rule),
                               .message = std::move(message)}});
}

bool DiagnosticList::Has(std::string_view rule) const {
  return std::any_of(kept_.begin(), kept_.end(),
                     [rule](const Entry& entry) { return entry.mistake.rule == rule; });
}

void DiagnosticList::Throw(const std::vector<Source>& sources, std::string_view allowed) {
  std::stable_sort(kept_.begin(), kept_.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.place.source, a.place.offset) < std::tie(b.place.source, b.place.offset);
  });
  std::vector<Diagnostic> mistakes;
  mistakes.reserve(kept_.size());
  std::size_t current = sources.size();
  LineCounter counter("");
  for (Entry& entry : kept_) {
    const Source& source = sources[entry.place.source];
    if (entry.place.source != current) {
      current = entry.place.source;
      counter = LineCounter(source.text);
    }
    entry.mistake.file = source.name;
    // An override has no lines. The other sources are files.
    entry.mistake.override_number = source.has_lines ? 0 : entry.place.source;
    if (source.has_lines) {
      counter.AdvanceTo(entry.place.offset);
      entry.mistake.line = counter.line();
      entry.mistake.column = counter.column();
    }
    mistakes.push_back(std::move(entry.mistake));
  }
  const std::string text = Text(mistakes, full() ? " or more" : "", allowed);
  throw ScenarioError(text, std::move(mistakes));
}

void ThrowUnreadable(std::string_view file, std::string_view message) {
  const Diagnostic mistake{.file = std::string(file),
                           .line = 0,
                           .column = 0,
                           .pointer = "",
                           .rule = "file",
                           .message = std::string(message)};
  throw ScenarioError(fmt::format("{}: error: {}", EscapeControls(file), message), {mistake});
}

}  // namespace fogline
