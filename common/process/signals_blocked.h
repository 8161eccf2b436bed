// Keeps signals away from threads that do not handle them.
#pragma once

#include <csignal>

namespace fogline {

/// While an object of this class exists, its thread gets no signals. A thread that this thread
/// starts in the meantime never gets a signal, even later. So the kernel gives signals to the other
/// threads, which handle them.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace fogline
