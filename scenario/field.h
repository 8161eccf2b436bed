// How a section of a scenario describes its own fields: one `Fields` function in each section
// visits every field with its name, range, unit, meaning and source. The loader, the JSON schema,
// the effective scenario and the parameter tables are made from these visits and from nothing else.
//
//   struct RadarSection {
//     double bias_m = 0.0;
//     template <class Self, class Visitor>
//     static void Fields(Self& self, Visitor& visit) {
//       visit.Number("bias_m", self.bias_m, {.min = -5, .max = 5, .unit = "m", .doc = "..."});
//     }
//   };
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace fogline {

/// A real number: closed range, unit ("" if none), meaning, and the source of the default: a
/// publication, a data sheet, or "our choice, because ...". No full stop at its end.
struct NumberSpec {
  double min;
  double max;
  std::string_view unit;
  std::string_view doc;
  std::string_view source;
};

/// An integer; in the file 3 and 3.0 are the same.
struct IntegerSpec {
  std::int64_t min;
  std::int64_t max;
  std::string_view unit;
  std::string_view doc;
  std::string_view source;
};

/// A list: how many items it may have.
struct ListSpec {
  std::int64_t min_items;
  std::int64_t max_items;
  std::string_view doc;
};

/// Longest text in a scenario file, in characters (Unicode code points). No character of a text is
/// a control character (C0, DEL, C1), so a text can be shown on any terminal.
inline constexpr std::int64_t kMaxTextLength = 4096;

/// When the choice `choice` is `value`, the section `section` must be there with at least one of
/// `fields` (texts or lists) that is not empty.
struct NeedSpec {
  std::string_view choice;
  std::string_view value;
  std::string_view section;
  std::array<std::string_view, 2> fields;
};

/// Names of an enumeration's values in their order, as they stand in the file. Specialise for each
/// enumeration: `static constexpr std::array kNames{...}` and, same size, `kDocs`. Where the values
/// are the rows of a table elsewhere, which alone knows their number, both are declared here as
/// `static const std::span<const std::string_view>`, and defined beside that table.
template <class Enum>
struct ChoiceNames;

}  // namespace fogline
