// The action of a verb of `fogline`, and its end.
#pragma once

#include <functional>
#include <stdexcept>

#include "common/exit_code.h"

namespace fogline::cli {

/// Action of the chosen verb; returns the exit code (common/exit_code.h).
using Action = std::function<int()>;

/// Ends a verb with kCheckFailed.
class CheckFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fogline::cli
