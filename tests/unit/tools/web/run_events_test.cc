#include "tools/web/run_events.h"

#include <gtest/gtest.h>

namespace fogline::web {
namespace {

TEST(RunEventsTest, NeedsBoundedMemoryForAnEndlessRun) {
  RunEvents events;
  for (std::int64_t step = 0; step < 50'000; ++step) {
    arbitration_t command{};
    command.header.step = step;
    command.mode = step % 2 == 0 ? arbitration_t::AUTOMATION : arbitration_t::REQUEST;
    events.Add(command, std::nullopt);
    ASSERT_TRUE(events.take_over().entries().empty());
    ASSERT_LE(events.take_over().requests().size(), 1U);
  }
  EXPECT_EQ(events.events().size(), RunEvents::kMost);
  EXPECT_GT(events.left_out(), 40'000U);
}

}  // namespace
}  // namespace fogline::web
