// Ctrl-C, seen at the next convenient moment.
#pragma once

#include <csignal>
#include <stdexcept>

namespace fogline {

/// Thrown out of long work when the user wants to stop: exit code 130.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace internal {
inline volatile std::sig_atomic_t interrupts = 0;
}

/// From now on SIGINT, SIGTERM and SIGHUP (the terminal is gone) are only noted.
inline void WatchInterrupts() {
  struct sigaction action {};
  action.sa_handler = [](int) { internal::interrupts = 1; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
}

inline bool WasInterrupted() { return internal::interrupts != 0; }

}  // namespace fogline
