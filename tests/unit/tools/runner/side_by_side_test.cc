#include "tools/runner/side_by_side.h"

#include <gtest/gtest.h>

#include <barrier>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace fogline::test {
namespace {

using runner::SideBySide;

TEST(SideBySideTest, DoesEachPieceOnce) {
  for (const int jobs : {1, 2, 7, 100}) {
    std::vector<int> calls(50);
    SideBySide(50, jobs, [&](std::int64_t i) { ++calls[static_cast<std::size_t>(i)]; });
    EXPECT_EQ(calls, std::vector<int>(50, 1)) << jobs;
  }
  SideBySide(0, 4, [](std::int64_t) { FAIL(); });
}

TEST(SideBySideTest, WorksOnAllPiecesAtOnceThatItMay) {
  // Each call waits for two others, so three calls must be under way.
  std::barrier together(3);
  SideBySide(9, 3, [&](std::int64_t) { together.arrive_and_wait(); });
}

TEST(SideBySideTest, OneJobWorksInTheCallingThreadAndInOrder) {
  std::vector<std::int64_t> order;
  const std::thread::id caller = std::this_thread::get_id();
  SideBySide(5, 1, [&](std::int64_t i) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    order.push_back(i);
  });
  EXPECT_EQ(order, (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
}

TEST(SideBySideTest, AnExceptionEndsTheWorkAndReachesTheCaller) {
  for (const int jobs : {1, 3}) {
    std::mutex mutex;
    std::set<std::int64_t> begun;
    const auto work = [&](std::int64_t i) {
      {
        const std::lock_guard lock(mutex);
        begun.insert(i);
      }
      if (i == 2) throw std::runtime_error("no");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    EXPECT_THROW(SideBySide(100'000, jobs, work), std::runtime_error);
    EXPECT_LT(begun.size(), 100'000U) << "the pieces after the exception are left out";
  }
}

}  // namespace
}  // namespace fogline::test
