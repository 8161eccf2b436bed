// How a run in real time ends if its log lacks messages that the network has lost.
#pragma once

namespace fogline::test {

/// Exit code of `fogline run` for a run that failed. On a network that loses messages a run may
/// fail for one reason only: the recorder cannot get all lost messages.
inline constexpr int kFailed = 3;
inline constexpr const char* kNotWhole =
    "fogline run: error: the log is not complete: it lacks at least ";

}  // namespace fogline::test
