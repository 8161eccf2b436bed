#include "scenario/sections/field_text.h"

#include <fmt/core.h>

#include "common/text.h"

namespace fogline {

std::string Range(const NumberSpec& spec) {
  return WithUnit(fmt::format("[{}, {}]", NumberText(spec.min), NumberText(spec.max)), spec.unit);
}

std::string Range(const IntegerSpec& spec) {
  return WithUnit(fmt::format("[{}, {}]", spec.min, spec.max), spec.unit);
}

std::string Allowed(const NumberSpec& spec) { return "a number in " + Range(spec); }

std::string Allowed(const IntegerSpec& spec) {
  return spec.min == spec.max ? WithUnit(std::to_string(spec.min), spec.unit)
                              : "an integer in " + Range(spec);
}

std::string AllowedText() {
  return fmt::format("a text of at most {} characters, none a control character", kMaxTextLength);
}

std::string Range(const ListSpec& spec) {
  return fmt::format("{} to {}", spec.min_items, spec.max_items);
}

}  // namespace fogline
