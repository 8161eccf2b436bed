// Calls a function several times, on several threads.
#pragma once

#include <cstdint>
#include <functional>

namespace fogline::runner {

/// Calls work(0) to work(count - 1), at most `jobs` of them at the same time. They begin in this
/// order. If `jobs` is 1 or less, the calls run on the calling thread, otherwise on new threads.
/// After an exception no further call begins.
/// @throws the first exception of `work`, when all calls have ended
void SideBySide(std::int64_t count, int jobs, const std::function<void(std::int64_t)>& work);

}  // namespace fogline::runner
