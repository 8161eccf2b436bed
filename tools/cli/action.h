// The action of a verb of `fogline`, and the exception with which an action reports a failed check.
#pragma once

#include <functional>
#include <stdexcept>

#include "common/exit_code.h"

namespace fogline::cli {

/// Action of the chosen verb; returns the exit code (common/exit_code.h).
using Action = std::function<int()>;

/// If an action throws this exception, the text of the exception is printed, and the exit code is
/// kCheckFailed.
class CheckFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fogline::cli
