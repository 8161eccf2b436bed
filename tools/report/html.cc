#include "tools/report/html.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "tools/report/metric_text.h"

namespace fogline::report {
namespace {

constexpr std::string_view kNoNumber = "–";
constexpr std::string_view kMinus = "−";

/// The character reference for `c`; "" if `c` needs none.
std::string_view Entity(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return "";
  }
}

std::string_view ValueOf(std::string_view name,
                         std::initializer_list<std::pair<std::string_view, std::string>> values) {
  for (const auto& [key, value] : values) {
    if (key == name) return value;
  }
  throw std::out_of_range("the page has no value for " + std::string(name));
}

}  // namespace

std::string EscapeHtml(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    const std::string_view entity = Entity(c);
    if (entity.empty()) {
      escaped += c;
    } else {
      escaped += entity;
    }
  }
  return escaped;
}

std::string EscapeScript(std::string_view json) {
  std::string escaped;
  escaped.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
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
