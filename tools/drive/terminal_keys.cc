#include "tools/drive/terminal_keys.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>

#include "common/errors.h"
#include "common/process/poll.h"

namespace fogline::drive {

RawTerminal::RawTerminal() {
  if (tcgetattr(STDIN_FILENO, &before_) != 0) {
    throw InputError("error: --keys: standard input is no terminal");
  }
  if (tcgetpgrp(STDIN_FILENO) != getpgrp()) {
    throw InputError("error: --keys: the program is not in the foreground of its terminal");
  }
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  if (tcsetattr(STDIN_FILENO, TCSANOW, &raw) != 0) {
    throw InputError("error: --keys: the terminal cannot be set to give single keys");
  }
}

// If this program is in the background, tcsetattr() causes the signal SIGTTOU, which stops the
// program. So the destructor blocks this signal.
RawTerminal::~RawTerminal() {
  sigset_t blocked;
  sigset_t mask;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTTOU);
  pthread_sigmask(SIG_BLOCK, &blocked, &mask);
  tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
  pthread_sigmask(SIG_SETMASK, &mask, nullptr);
}

int TerminalKeys::fd() const { return closed_ ? -1 : STDIN_FILENO; }

PedalState TerminalKeys::Read(TimePoint now) {
  std::array<char, 256> characters{};
  while (!closed_ && PollFor(STDIN_FILENO, POLLIN, Duration::zero()) > 0) {
    const ssize_t size = read(STDIN_FILENO, characters.data(), characters.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) break;
    // The terminal is readable, but has no character: it was closed.
    if (size <= 0) closed_ = true;
    if (closed_) break;
    at_ = now;
    parser_.Parse({characters.data(), static_cast<std::size_t>(size)}, [&](TerminalKey key) {
      if (key == TerminalKey::kThrottle) pedals_.Character(PedalKey::kThrottle, now);
      if (key == TerminalKey::kBrake) pedals_.Character(PedalKey::kBrake, now);
      if (key == TerminalKey::kTakeOver) take_over_until_ = now + kButton;
      if (key == TerminalKey::kGiveBack) give_back_until_ = now + kButton;
    });
  }
  pedals_.MoveTo(now);
  PedalState state{.present = !closed_,
                   .throttle = pedals_.throttle(),
                   .brake = pedals_.brake(),
                   .axes = {},
                   .buttons = 0,
                   .at = at_};
  if (now < take_over_until_) state.buttons |= driver_input_t::TAKE_OVER;
  if (now < give_back_until_) state.buttons |= driver_input_t::GIVE_BACK;
  return state;
}

}  // namespace fogline::drive
