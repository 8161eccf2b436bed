// How a run in real time ends if its network has lost messages for good.
#pragma once

namespace fogline::test {

/// Exit code of `fogline run` for a run that failed. On a network that loses messages it has one
/// allowed reason: the recorder cannot get all messages again.
inline constexpr int kFailed = 3;
inline constexpr const char* kNotWhole =
    "fogline run: error: the log is not complete: it lacks at least ";

}  // namespace fogline::test
