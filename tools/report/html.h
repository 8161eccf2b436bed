// Text that goes into the page.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace fogline {

/// `text` as HTML text or attribute value.
std::string EscapeHtml(std::string_view text);

/// JSON text that may stand in a script element: no "<" is left in it.
std::string EscapeScript(std::string_view json);

/// `page` with every {{name}} replaced by its value. Values are not looked into.
/// @throws std::out_of_range if a name has no value
std::string Fill(std::string_view page,
                 std::initializer_list<std::pair<std::string_view, std::string>> values);

/// A number with that many decimals and a true minus sign; "–" if it is none.
std::string Decimal(double value, int decimals);

/// The same in a data element, which carries the exact number too.
std::string DataElement(double value, int decimals);

/// The same of a measure, by MeasureText().
std::string MeasureElement(std::string_view name, double value, std::string_view unit);

}  // namespace fogline
