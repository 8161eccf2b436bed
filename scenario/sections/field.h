// Description of the fields of a section: one `Fields` function in each section visits every field
// with its name, range, unit, meaning and source. The loader, the JSON schema, the effective
// scenario and the parameter tables all use these visits.
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

/// A real number: closed range, unit ("" if none), meaning, and the source of the default. The
/// source is a publication, a data sheet, or "our choice, because ..."; it has no full stop at its
/// end.
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

/// If the choice `choice` is `value`, the file must have the section `section`, and at least one of
/// its `fields` (texts or lists) must not be empty.
struct NeedSpec {
  std::string_view choice;
  std::string_view value;
  std::string_view section;
  std::array<std::string_view, 2> fields;
};

/// Names of an enumeration's values in their order, as written in the file. Each enumeration has a
/// specialisation with `static constexpr std::array kNames{...}` and `kDocs` of the same size. If
/// the values are the rows of a table in another file, the specialisation declares both as `static
/// const std::span<const std::string_view>`; the file of the table defines them.
template <class Enum>
struct ChoiceNames;

}  // namespace fogline
