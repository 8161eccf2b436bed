// The signals that ask a process to end, seen at the next convenient moment: SIGINT (Ctrl-C),
// SIGTERM, SIGHUP (the terminal is gone).
#pragma once

#include <csignal>
#include <stdexcept>
#include <vector>

namespace fogline {

/// Thrown out of long work when the user wants to stop: exit code 130.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace internal {
inline volatile std::sig_atomic_t interrupts = 0;
}

/// Those of the signals that this process is to obey: not those that were ignored when it was
/// started, as by nohup.
inline std::vector<int> EndingSignals() {
  std::vector<int> obeyed;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction present {};
    if (sigaction(signal, nullptr, &present) == 0 && present.sa_handler == SIG_IGN) continue;
    obeyed.push_back(signal);
  }
  return obeyed;
}

/// From now on these signals are only noted.
inline void WatchInterrupts() {
  struct sigaction action {};
  action.sa_handler = [](int) { internal::interrupts = 1; };
  for (const int signal : EndingSignals()) sigaction(signal, &action, nullptr);
}

inline bool WasInterrupted() { return internal::interrupts != 0; }

}  // namespace fogline
