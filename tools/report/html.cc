#include "tools/report/html.h"

#include <cmath>
#include <stdexcept>

#include <boost/algorithm/string/replace.hpp>

#include <fmt/format.h>

#include "tools/report/metric_text.h"

namespace fogline::report {
namespace {

constexpr std::string_view kNoNumber = "–";
constexpr std::string_view kMinus = "−";

std::string_view ValueOf(std::string_view name,
                         std::initializer_list<std::pair<std::string_view, std::string>> values) {
  for (const auto& [key, value] : values) {
    if (key == name) return value;
  }
  throw std::out_of_range("the page has no value for " + std::string(name));
}

}  // namespace

std::string EscapeHtml(std::string_view text) {
  std::string escaped(text);
  boost::replace_all(escaped, "&", "&amp;");  // first, because the next lines insert "&"
  boost::replace_all(escaped, "<", "&lt;");
  boost::replace_all(escaped, ">", "&gt;");
  boost::replace_all(escaped, "\"", "&quot;");
  boost::replace_all(escaped, "'", "&#39;");
  return escaped;
}

std::string EscapeScript(std::string_view json) {
  return boost::replace_all_copy(std::string(json), "<", "\\u003c");
}

std::string Fill(std::string_view page,
                 std::initializer_list<std::pair<std::string_view, std::string>> values) {
  std::string filled;
  for (;;) {
    const std::size_t open = page.find("{{");
    const std::size_t close = page.find("}}", open);
    if (open == std::string_view::npos || close == std::string_view::npos) break;
    filled += page.substr(0, open);
    filled += ValueOf(page.substr(open + 2, close - open - 2), values);
    page.remove_prefix(close + 2);
  }
  filled += page;
  return filled;
}

std::string FigureElement(std::string_view id, std::string_view heading, std::string_view caption,
                          std::string_view axis) {
  return fmt::format(
      "<figure id=\"{0}\" aria-labelledby=\"{0}-title\">\n<figcaption><h3 id=\"{0}-title\">{1}"
      "</h3><p>{2}</p></figcaption>\n<p class=\"axis\">{3}</p>\n<div class=\"panels\"></div>\n"
      "<div class=\"legend\"></div>\n</figure>\n",
      id, heading, caption, axis);
}

std::string Decimal(double value, int decimals) {
  if (!std::isfinite(value)) return std::string(kNoNumber);
  std::string text = fmt::format("{:.{}f}", std::fabs(value), decimals);
  const bool rounds_to_zero = text.find_first_not_of("0.") == std::string::npos;
  if (value < 0 && !rounds_to_zero) text.insert(0, kMinus);
  return text;
}

std::string DataElement(double value, int decimals) {
  if (!std::isfinite(value)) return std::string(kNoNumber);
  return fmt::format("<data value=\"{}\">{}</data>", value, Decimal(value, decimals));
}

std::string MetricElement(std::string_view name, double value, std::string_view unit) {
  if (!std::isfinite(value)) return std::string(kNoNumber);
  std::string text = MetricText(name, value, unit);
  if (const std::size_t minus = text.find('-'); minus != std::string::npos) {
    text.replace(minus, 1, kMinus);
  }
  return fmt::format("<data value=\"{}\">{}</data>", value, EscapeHtml(text));
}

}  // namespace fogline::report
