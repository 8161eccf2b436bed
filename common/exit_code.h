// The exit codes. Each code has the same meaning in all programs.
#pragma once

namespace fogline {

enum ExitCode : int {
  kDone = 0,
  kCheckFailed = 1,   // a check has found a fault or a difference
  kBadInput = 2,      // a mistake in the arguments or in a file (InputError)
  kRunFailed = 3,     // a failure at run time
  kInterrupted = 130  // ended by a signal that asks a process to end (Interrupted)
};

}  // namespace fogline
