// Collects the mistakes of a scenario during reading, and turns them into one error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/io/loader.h"

namespace fogline {

/// A source of text that can have mistakes: a file or an override.
struct Source {
  std::string name;
  std::string_view text;
  bool has_lines = true;  // false for an override: its name alone says where a mistake is
};

/// Place in a text: the index of a source, and the offset in bytes in the text of that source.
struct Place {
  std::uint32_t source = 0;
  std::uint32_t offset = 0;
};

/// The mistakes found so far. The list keeps the first 1000 mistakes and drops all others, so that
/// a hostile file cannot use much memory or time.
class DiagnosticList {
 public:
  void Add(Place place, std::string pointer, std::string_view rule, std::string message);

  bool full() const { return kept_.size() >= kMaxKept; }
  bool empty() const { return kept_.empty(); }
  bool Has(std::string_view rule) const;

  /// @pre the list is not empty, and `sources` has the source of every place
  /// @param allowed the command that shows the allowed values; "" stands for the command for a
  ///     scenario (fogline check --explain)
  /// @throws ScenarioError with all mistakes, sorted by their places
  [[noreturn]] void Throw(const std::vector<Source>& sources, std::string_view allowed = "");

 private:
  struct Entry {
    Place place;
    Diagnostic mistake;
  };
  static constexpr std::size_t kMaxKept = 1000;

  std::vector<Entry> kept_;
};

/// Reports a file that cannot be read at all. @throws ScenarioError with this one mistake
[[noreturn]] void ThrowUnreadable(std::string_view file, std::string_view message);

}  // namespace fogline
