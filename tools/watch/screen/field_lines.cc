#include "tools/watch/screen/field_lines.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <type_traits>

#include <fmt/core.h>

#include "common/text.h"

namespace fogline::watch {
namespace {

/// At most this many characters of a text are shown. Some texts are long: a part of the scenario in
/// RUN has 1,000 characters.
constexpr std::size_t kMaxText = 300;

template <class V>
std::string ValueText(const V& value) {
  if constexpr (std::is_same_v<V, std::string>) {
    return Printable(value.substr(0, kMaxText));
  } else if constexpr (std::is_same_v<V, std::int8_t>) {
    return std::to_string(value);
  } else {
    return fmt::format("{}", value);
  }
}

void AddLine(std::string_view name, const std::string& value, std::vector<std::string>& lines) {
  lines.push_back(fmt::format("{:<24} {}", name, value));
}

template <class M>
std::vector<std::string> LinesOf(const M& message) {
  std::vector<std::string> lines;
  VisitFields(message, [&lines]<class V>(std::string_view name, const V& value) {
    if constexpr (std::is_same_v<V, header_t>) {
      AddLine("header.run_id", std::to_string(value.run_id), lines);
      AddLine("header.step", std::to_string(value.step), lines);
      AddLine("header.utime", std::to_string(value.utime), lines);
    } else if constexpr (requires { value.subspan(0); }) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        AddLine(fmt::format("{}[{}]", name, i), ValueText(value[i]), lines);
      }
    } else {
      AddLine(name, ValueText(value), lines);
    }
  });
  return lines;
}

std::vector<std::string> HexLines(runtime::Bytes message) {
  constexpr std::size_t kPerLine = 16;
  constexpr std::size_t kMost = 256;
  std::vector<std::string> lines{fmt::format("{} bytes of no known type", message.size())};
  const std::size_t end = std::min(message.size(), kMost);
  for (std::size_t at = 0; at < end; at += kPerLine) {
    std::string line = fmt::format("{:>4} ", at);
    for (std::size_t i = at; i < std::min(end, at + kPerLine); ++i) {
      line += fmt::format(" {:02x}", message[i]);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

template <class M>
bool LinesIfDecoded(runtime::Bytes bytes, std::vector<std::string>& lines) {
  M message{};
  if (!runtime::Decode(bytes, message)) return false;
  lines = LinesOf(message);
  return true;
}

}  // namespace

std::vector<std::string> FieldLines(std::string_view channel, runtime::Bytes message) {
  std::vector<std::string> lines;
  const bool decoded = std::apply(
      [&]<class... M>(const Channel<M>&... known) {
        return ((known.name == channel && LinesIfDecoded<M>(message, lines)) || ...);
      },
      kGraph);
  return decoded ? lines : HexLines(message);
}

std::vector<std::string> FieldLines(const status_t& status) { return LinesOf(status); }

}  // namespace fogline::watch
