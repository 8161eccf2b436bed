// How a run in real time ends if its network has lost messages for good.
#pragma once

namespace fogline::test {

/// Exit code of `fogline run` where a run failed. On a network that loses messages there is one
/// allowed reason for it: the recorder cannot have everything again.
inline constexpr int kFailed = 3;
inline constexpr const char* kNotWhole =
    "fogline run: error: the log is not complete: it lacks at least ";

}  // namespace fogline::test
