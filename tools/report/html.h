// Escapes and formats text for the HTML pages of reports and studies.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace fogline::report {

/// `text`, escaped for use as HTML text or as an attribute value.
std::string EscapeHtml(std::string_view text);

/// The JSON text with each "<" escaped, because "</script>" in the text would end a script element.
std::string EscapeScript(std::string_view json);

/// `page` with every {{name}} replaced by its value. Placeholders within values are not replaced.
/// @throws std::out_of_range if a name has no value
std::string Fill(std::string_view page,
                 std::initializer_list<std::pair<std::string_view, std::string>> values);

/// The frame of a figure, into which a script draws. The texts are HTML. @param axis name of the y
/// axis
std::string FigureElement(std::string_view id, std::string_view heading, std::string_view caption,
                          std::string_view axis);

/// A number with this many decimals and a true minus sign; "–" for NaN and infinity.
std::string Decimal(double value, int decimals);

/// Decimal() in a data element, whose value attribute has the exact number.
std::string DataElement(double value, int decimals);

/// A data element for a measure, formatted by MetricText().
std::string MetricElement(std::string_view name, double value, std::string_view unit);

}  // namespace fogline::report
