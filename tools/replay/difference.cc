#include "tools/replay/difference.h"

#include <algorithm>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/core.h>

#include "services/runtime/wire/wire.h"

namespace fogline::replay {
namespace {

/// A field of a message as "name[index]" and its value in the shortest exact form.
struct Field {
  std::string name;
  std::string value;
};

template <class M>
std::vector<Field> FieldsOf(const M& message) {
  std::vector<Field> fields;
  VisitFields(message, [&fields]<class V>(std::string_view name, const V& value) {
    if constexpr (std::is_same_v<V, header_t>) {
      fields.push_back({"header.step", std::to_string(value.step)});
      fields.push_back({"header.utime", std::to_string(value.utime)});
    } else if constexpr (requires {
                           value.size();
                           value[0];
                         } &&
                         !std::is_same_v<V, std::string>) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        fields.push_back({fmt::format("{}[{}]", name, i), fmt::format("{}", value[i])});
      }
    } else if constexpr (std::is_same_v<V, std::int8_t>) {
      fields.push_back({std::string(name), std::to_string(value)});
    } else {
      fields.push_back({std::string(name), fmt::format("{}", value)});
    }
  });
  return fields;
}

/// Whether two messages are equal except for the run id, which the digest also ignores. An empty
/// message is a message that is missing, which occurs in real time.
bool SameRunAside(runtime::Bytes a, runtime::Bytes b) {
  if (a.empty() || b.empty()) return a.empty() == b.empty();
  return std::ranges::equal(a.first(runtime::kRunIdOffset), b.first(runtime::kRunIdOffset)) &&
         std::ranges::equal(a.subspan(runtime::kStepOffset), b.subspan(runtime::kStepOffset));
}

template <class M>
Difference FirstField(std::int64_t step, runtime::Bytes a, runtime::Bytes b) {
  Difference difference{.step = step, .channel = std::string(ChannelOf<M>().name)};
  if (a.empty() || b.empty()) {
    difference.field = "(message)";
    difference.a = a.empty() ? "none" : "there";
    difference.b = b.empty() ? "none" : "there";
    return difference;
  }
  M message_a{};
  M message_b{};
  const bool reads_a = runtime::Decode(a, message_a);
  const bool reads_b = runtime::Decode(b, message_b);
  if (!reads_a || !reads_b) {
    difference.field = "(does not decode)";
    difference.a = reads_a ? "decodes" : "does not";
    difference.b = reads_b ? "decodes" : "does not";
    return difference;
  }
  const std::vector<Field> fields_a = FieldsOf(message_a);
  const std::vector<Field> fields_b = FieldsOf(message_b);
  for (std::size_t i = 0; i < std::min(fields_a.size(), fields_b.size()); ++i) {
    if (fields_a[i].name == fields_b[i].name && fields_a[i].value == fields_b[i].value) continue;
    difference.field = fields_a[i].name;
    difference.a = fields_a[i].value;
    difference.b = fields_b[i].value;
    return difference;
  }
  return difference.field = "(number of values)", difference;
}

}  // namespace

std::optional<Difference> FirstDifference(std::size_t channel, std::int64_t step, runtime::Bytes a,
                                          runtime::Bytes b) {
  std::optional<Difference> first;
  ForEachStepChannel([&]<class M>(std::size_t i) {
    if (i == channel && !SameRunAside(a, b)) first = FirstField<M>(step, a, b);
  });
  return first;
}

std::optional<Difference> FirstDifference(std::int64_t step, const log::StepMessages& a,
                                          const log::StepMessages& b) {
  for (std::size_t channel = 0; channel < kNumChannels; ++channel) {
    if (auto first = FirstDifference(channel, step, a[channel], b[channel])) return first;
  }
  return std::nullopt;
}

}  // namespace fogline::replay
