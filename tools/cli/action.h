// The action of a verb of `fogline`, and the exception with which an action reports a failed check.
#pragma once

#include <functional>
#include <stdexcept>

#include "common/exit_code.h"

namespace fogline::cli {

/// Action of the chosen verb; returns the exit code (common/exit_code.h).
using Action = std::function<int()>;

/// An action that throws this ends with the exit code kCheckFailed, and its text is printed.
class CheckFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fogline::cli
