// The first field in which two messages, or two runs, differ.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/recorder/run_log.h"

namespace fogline {

/// Values in the shortest form that tells any two apart.
struct Difference {
  std::int64_t step = 0;
  std::string channel;
  std::string field;  // "name[index]"; in parentheses what is no field
  std::string a;
  std::string b;
};

/// The first difference between two messages of a channel (its place in kChannels), whatever the
/// run ids: what the digest looks at. Empty bytes stand for no message, as in real time there may
/// be.
std::optional<Difference> FirstDifference(std::size_t channel, std::int64_t step, Bytes a, Bytes b);

/// The same of all channels of a step, in the order of the graph table.
std::optional<Difference> FirstDifference(std::int64_t step, const StepMessages& a,
                                          const StepMessages& b);

}  // namespace fogline
