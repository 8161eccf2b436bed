#include "tools/runner/side_by_side.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace fogline::runner {

void SideBySide(std::int64_t count, int jobs, const std::function<void(std::int64_t)>& work) {
  if (jobs <= 1) {
    for (std::int64_t i = 0; i < count; ++i) work(i);
    return;
  }
  std::mutex mutex;
  std::int64_t next = 0;
  std::exception_ptr first;
  const auto take = [&]() -> std::int64_t {
    const std::lock_guard lock(mutex);
    return first ? count : next < count ? next++ : count;
  };
  {
    std::vector<std::jthread> threads;
    for (std::int64_t job = 0; job < std::min<std::int64_t>(jobs, count); ++job) {
      threads.emplace_back([&] {
        for (std::int64_t i = take(); i < count; i = take()) {
          try {
            work(i);
          } catch (...) {
            const std::lock_guard lock(mutex);
            if (!first) first = std::current_exception();
          }
        }
      });
    }
  }
  if (first) std::rethrow_exception(first);
}

}  // namespace fogline::runner
