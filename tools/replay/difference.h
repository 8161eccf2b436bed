// The first field in which two messages, or two runs, differ.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/log/run_log.h"

namespace fogline::replay {

/// A field in which two messages differ. Its two values are printed in the shortest form that
/// distinguishes any two numbers.
struct Difference {
  std::int64_t step = 0;
  std::string channel;
  std::string field;  // "name[index]", or a reason such as "(message)" if one message is missing
  std::string a;
  std::string b;
};

/// The first difference between two messages of a channel (an index in kChannels). The run ids are
/// ignored, as in the digest. Empty bytes stand for a missing message, which occurs in real time.
std::optional<Difference> FirstDifference(std::size_t channel, std::int64_t step, runtime::Bytes a,
                                          runtime::Bytes b);

/// The first difference in any channel of a step, in the order of the graph table.
std::optional<Difference> FirstDifference(std::int64_t step, const log::StepMessages& a,
                                          const log::StepMessages& b);

}  // namespace fogline::replay
