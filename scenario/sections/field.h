// How the sections of a scenario declare their fields. One declaration contains everything about a
// field:
//
//   struct RadarSection {
//     FOGLINE_FIELD(double, bias_m, 0.954, {-10, 10, "m"}, "Mounting offset that ...",
//                   "our choice, because ...");
//     FOGLINE_FIELD(bool, gating, false, "Refuse measurements outside the gate.");
//   };
//
// The struct has the members `double bias_m = 0.954;` and `bool gating = false;`. The arguments
// after the default depend on the type:
//
//   double                      NumberSpec, meaning, source of the default
//   std::int64_t                IntegerSpec, meaning, source of the default
//   bool, std::string, an enum  meaning
//   a section                   meaning; also a NeedSpec if some files must have the section
//   a std::vector of double     ListSpec, NumberSpec, meaning, source
//   a std::vector of texts      ListSpec, meaning
//   a std::vector of sections   ListSpec, meaning
//
// A source is a publication, a data sheet, or "our choice, because ...". A source has no full stop
// at its end. field_view.h lists all fields for code that reads, prints, sets or explains them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fogline {

/// The range of a real number and its unit ("" if it has none). The limits belong to the range.
struct NumberSpec {
  double min;
  double max;
  std::string_view unit = "";
};

/// The range of an integer and its unit. The limits belong to the range. In the file, 3 and 3.0 are
/// the same integer.
struct IntegerSpec {
  std::int64_t min;
  std::int64_t max;
  std::string_view unit = "";
};

/// The allowed number of items of a list.
struct ListSpec {
  std::int64_t min_items;
  std::int64_t max_items;
};

/// Longest text in a scenario file, in characters (Unicode code points). A text has no control
/// characters (C0, DEL, C1), so it can be shown on any terminal.
inline constexpr std::int64_t kMaxTextLength = 4096;

/// The condition under which a file must have a section: the field `choice`, in the same JSON
/// object as the section, has the value `value`. In this case, at least one of the section's
/// `fields` (texts or lists) must not be empty.
struct NeedSpec {
  std::string_view choice;
  std::string_view value;
  std::array<std::string_view, 2> fields;
};

/// A value of an enumeration: its name in the file, and its meaning.
struct Choice {
  std::string_view name;
  std::string_view doc;
};

/// One column of `choices`: the names of the values, or their meanings.
template <std::size_t size>
constexpr auto ColumnOf(const std::array<Choice, size>& choices, std::string_view Choice::*column) {
  std::array<std::string_view, size> texts;
  for (std::size_t i = 0; i < size; ++i) texts[i] = choices[i].*column;
  return texts;
}

/// Names and meanings of an enumeration's values in their order. Each enumeration has a function
/// `constexpr auto ChoicesOf(Enum)` that returns the names and meanings as an std::array of Choice.
template <class Enum>
struct ChoiceNames {
  static constexpr auto kNames = ColumnOf(ChoicesOf(Enum()), &Choice::name);
  static constexpr auto kDocs = ColumnOf(ChoicesOf(Enum()), &Choice::doc);
};

/// A line of a source file. SourceLine<N> converts to SourceLine<M> for every line M above line N.
/// In overload resolution, the nearest line above is the best match.
template <int number>
struct SourceLine : SourceLine<number - 1> {};
template <>
struct SourceLine<0> {};

/// Largest line number that a field may have in its file.
inline constexpr int kLastFieldLine = 500;

/// Declares a field of a section, as described above. Besides the member, the macro defines an
/// overload of VisitFieldsUpTo() for the field's line. This overload calls the overload of the
/// nearest field above, and then visits its own field. So VisitFieldsUpTo(visitor,
/// SourceLine<kLastFieldLine>()) visits all fields of the section in their order. Line numbers are
/// the same wherever the header is included, so all source files get the same overloads.
#define FOGLINE_FIELD(type, name, default_value, ...)                                         \
  static_assert(__LINE__ <= ::fogline::kLastFieldLine, "split this file or raise the limit"); \
  template <class Visitor>                                                                    \
  void VisitFieldsUpTo(Visitor& visitor, ::fogline::SourceLine<__LINE__>) {                   \
    using Above = ::fogline::SourceLine<__LINE__ - 1>;                                        \
    if constexpr (requires { this->VisitFieldsUpTo(visitor, Above()); }) {                    \
      this->VisitFieldsUpTo(visitor, Above());                                                \
    }                                                                                         \
    visitor(#name, this->name, __VA_ARGS__);                                                  \
  }                                                                                           \
  type name = default_value

}  // namespace fogline
