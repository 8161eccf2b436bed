// The signals that ask a process to end: SIGINT (Ctrl-C), SIGTERM, SIGHUP (the terminal was
// closed). The signal handler only sets a flag. The process ends when it next checks this flag.
#pragma once

#include <csignal>
#include <stdexcept>
#include <vector>

namespace fogline {

/// Thrown from long work after a signal that asks the process to end. The exit code is then 130.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace internal {
inline volatile std::sig_atomic_t interrupts = 0;
}

/// The signals that this process obeys. A signal that was ignored at the start of the process stays
/// ignored (nohup ignores SIGHUP).
inline std::vector<int> EndingSignals() {
  std::vector<int> obeyed;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction present {};
    if (sigaction(signal, nullptr, &present) == 0 && present.sa_handler == SIG_IGN) continue;
    obeyed.push_back(signal);
  }
  return obeyed;
}

/// After this call, a signal of EndingSignals() only sets the flag of WasInterrupted().
inline void WatchInterrupts() {
  struct sigaction action {};
  action.sa_handler = [](int) { internal::interrupts = 1; };
  for (const int signal : EndingSignals()) sigaction(signal, &action, nullptr);
}

inline bool WasInterrupted() { return internal::interrupts != 0; }

}  // namespace fogline
