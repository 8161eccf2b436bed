#include "common/process/console.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <mutex>
#include <string>

#include <fmt/core.h>

#include "common/clock.h"
#include "common/text.h"

namespace fogline {
namespace {

// Longest wait for a reader that reads nothing, such as a pager that waits for a key. The wait is
// limited, because a process that has failed keeps its log locked until the process ends.
constexpr Duration kReaderLimit = milliseconds(5000);

/// While an object of this class exists, two signals do not end or stop the process when this
/// thread writes. SIGPIPE comes when a pipe has no reader. SIGTTOU comes when a background process
/// writes to a terminal that forbids this (`stty tostop`). All other writes behave as usual: in
/// `fogline digest *.lcm | head`, SIGPIPE ends `fogline digest`.
class WithoutSignals {
 public:
  WithoutSignals() {
    sigemptyset(&sigpipe_);
    sigaddset(&sigpipe_, SIGPIPE);
    sigset_t pending;
    sigpending(&pending);
    was_pending_ = sigismember(&pending, SIGPIPE) == 1;
    sigset_t both = sigpipe_;
    sigaddset(&both, SIGTTOU);  // if SIGTTOU is blocked, the kernel allows the write
    pthread_sigmask(SIG_BLOCK, &both, &before_);
  }
  ~WithoutSignals() {
    constexpr timespec kNow{};
    if (!was_pending_) sigtimedwait(&sigpipe_, nullptr, &kNow);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  WithoutSignals(const WithoutSignals&) = delete;
  WithoutSignals& operator=(const WithoutSignals&) = delete;

 private:
  sigset_t sigpipe_{};
  sigset_t before_{};
  bool was_pending_ = false;
};

/// Writes to stderr. A write waits for room, but not longer than a limit. The limit may be 0.
///
/// A pipe or terminal is opened a second time, by its name in /proc, so that writes to it do not
/// wait. O_NONBLOCK on descriptor 2 itself would affect all processes to which the shell has given
/// this descriptor. If the second open fails (a terminal of another user), poll() checks for room
/// before each write. A thread with a queue could replace the second open and poll(). But then each
/// process would have to wait at its end until its last lines are written.
class Stderr {
 public:
  /// The only object of this class. The object is never destroyed, because destructors of other
  /// objects may write.
  static Stderr& Get() {
    static auto* const only = new Stderr;
    return *only;
  }

  void WriteLine(std::string line, Duration limit) {
    const std::scoped_lock lock(mutex_);
    if (waited_in_vain_) limit = Duration::zero();
    if (dropped_ > 0) line.insert(0, fmt::format("... {} lines are missing here\n", dropped_));
    if (Write(line, limit)) {
      dropped_ = 0;
      waited_in_vain_ = false;
    } else {
      ++dropped_;
      waited_in_vain_ = waited_in_vain_ || limit > Duration::zero();
    }
  }

  void WriteText(std::string_view text) {
    const std::scoped_lock lock(mutex_);
    Write(text, Duration::zero());
  }

 private:
  Stderr() {
    struct stat info {};
    if (fstat(STDERR_FILENO, &info) != 0 || S_ISREG(info.st_mode)) return;  // writes do not wait
    is_socket_ = S_ISSOCK(info.st_mode);
    const int own = is_socket_ ? -1
                               : open("/proc/self/fd/2",
                                      O_WRONLY | O_APPEND | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (own >= 0) fd_ = own;
    asks_first_ = !is_socket_ && own < 0;
  }

  /// @return whether the text or its beginning was written; the next call writes the rest first
  bool Write(std::string_view text, Duration limit) {
    const WithoutSignals scope;
    const TimePoint end = Clock::now() + limit;
    rest_.erase(0, Put(rest_, end));
    if (!rest_.empty()) return false;
    const std::size_t written = Put(text, end);
    if (written > 0) rest_ = text.substr(written);  // the next call writes this rest first
    return written > 0;
  }

  /// @return how many bytes were written until `end`
  std::size_t Put(std::string_view text, TimePoint end) {
    std::size_t written = 0;
    while (written < text.size()) {
      if (asks_first_ && !HasRoom(end)) break;
      const ssize_t size = PutOnce(text.substr(written));
      if (size > 0) {
        written += static_cast<std::size_t>(size);
      } else if (size < 0 && errno == EAGAIN ? !HasRoom(end) : errno != EINTR) {
        break;
      }
    }
    return written;
  }

  ssize_t PutOnce(std::string_view text) const {
    if (is_socket_) return send(fd_, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    // If poll() reports room in a pipe, the pipe takes at least this many bytes in one write.
    const std::size_t piece = asks_first_ ? std::size_t{_POSIX_PIPE_BUF} : text.size();
    return write(fd_, text.data(), std::min(text.size(), piece));
  }

  bool HasRoom(TimePoint end) const {
    while (true) {
      pollfd waited{.fd = fd_, .events = POLLOUT, .revents = 0};
      const std::int64_t left = std::max<std::int64_t>(0, Milliseconds(end - Clock::now()));
      const int ready = poll(&waited, 1, static_cast<int>(left));
      if (ready > 0) return (waited.revents & POLLOUT) != 0;
      if (ready == 0 || errno != EINTR) return false;
    }
  }

  std::mutex mutex_;
  int fd_ = STDERR_FILENO;
  bool is_socket_ = false;
  bool asks_first_ = false;      // calls poll() first, because a write might wait
  std::string rest_;             // the unwritten part of the newest text
  std::int64_t dropped_ = 0;     // number of lines dropped since the last written line
  bool waited_in_vain_ = false;  // whether a dropped line has waited for room
};

void WriteLine(std::string_view line, Duration limit) noexcept {
  try {
    Stderr::Get().WriteLine(EscapeLines(line) + '\n', limit);
  } catch (...) {  // without memory nothing can be printed
  }
}

}  // namespace

void Notice(std::string_view line) noexcept { WriteLine(line, Duration::zero()); }

void Complain(std::string_view line) noexcept { WriteLine(line, kReaderLimit); }

void Draw(std::string_view text) noexcept {
  try {
    Stderr::Get().WriteText(text);
  } catch (...) {
  }
}

void TakeStandardDescriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0) continue;
    // open() returns the lowest free descriptor, which is `descriptor` here. The mode makes every
    // use of the descriptor fail, like the use of a closed descriptor.
    open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

}  // namespace fogline
