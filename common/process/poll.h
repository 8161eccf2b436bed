// Waits for a file or socket with a time limit in nanoseconds. poll() would allow only whole
// milliseconds.
#pragma once

#include <poll.h>

#include <algorithm>

#include "common/clock.h"

namespace fogline {

/// Waits until the file is ready for `events`, but no longer than `timeout`. If `file` is -1, the
/// function waits for the whole time.
/// @return as ppoll(): above 0 if the file is ready, 0 after the time limit, -1 with errno (EINTR:
/// a signal)
inline int PollFor(int file, short events, Duration timeout) {
  pollfd waited{.fd = file, .events = events, .revents = 0};
  const auto left = std::max(Duration::zero(), timeout);
  const timespec limit{.tv_sec = duration_cast<std::chrono::seconds>(left).count(),
                       .tv_nsec = static_cast<long>((left % std::chrono::seconds(1)).count())};
  return ppoll(&waited, 1, &limit, nullptr);
}

}  // namespace fogline
