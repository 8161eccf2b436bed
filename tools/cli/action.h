// What a verb of `fogline` does, and how it ends.
#pragma once

#include <functional>
#include <stdexcept>

namespace fogline::cli {

/// Action of the chosen verb; returns the exit code.
using Action = std::function<int()>;

/// Exit codes of every verb.
enum ExitCode : int {
  kDone = 0,
  kCheckFailed = 1,
  kBadInput = 2,
  kRunFailed = 3,
  kInterrupted = 130
};

/// Ends a verb with kCheckFailed.
class CheckFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fogline::cli
