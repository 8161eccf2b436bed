// Bursts of message loss, of every kind.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <deque>
#include <utility>

#include "tests/integration/realtime/loss_bursts.h"

namespace fogline::test {
namespace {

/// How often the test makes each of the 100 kinds of burst: FOGLINE_TEST_BURSTS / 100 times, but at
/// least once. Without this variable: twice.
std::size_t Repeats() {
  const char* bursts = std::getenv("FOGLINE_TEST_BURSTS");
  return bursts == nullptr ? 2 : static_cast<std::size_t>(std::max(1, std::atoi(bursts) / 100));
}

TEST_F(LossBurstInRealtimeTest, IsOverASecondAfterTheNetworkIsClean) {
  const std::size_t repeats = Repeats();
  std::deque<BurstPlan> plans;
  for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
    for (const int machines : {1, 3}) {
      for (const int rate_hz : {10, 50}) {
        for (const int loss_pct : {10, 30, 70, 90, 100}) {
          BurstPlan plan{.rate_hz = rate_hz, .machines = machines, .bursts = {}, .clean_s = 2};
          for (const double length_s : {0.1, 0.3, 1.0, 2.0, 3.0}) {
            // With three machines, every second burst hits only one machine.
            const std::size_t number = plan.bursts.size();
            const bool one = machines > 1 && (repeat + number) % 2 == 1;
            plan.bursts.push_back({loss_pct, length_s, one ? number % 3 : kEverywhere});
          }
          plans.push_back(std::move(plan));
        }
      }
    }
  }
  ASSERT_FALSE(plans.empty());
  constexpr unsigned kAtOnce = 4;
  Judge(PlayAll(std::move(plans), kAtOnce), 1.0);
  Print();
}

}  // namespace
}  // namespace fogline::test
