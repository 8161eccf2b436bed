// Keeps signals in the thread that handles them.
#pragma once

#include <csignal>

namespace fogline {

/// While an object lives, this thread and the threads that it starts get no signals. A thread that
/// is started meanwhile never gets one, so signals reach the threads that wait for them.
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
