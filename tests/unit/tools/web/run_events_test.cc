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

TEST(RunEventsTest, DoNotBeginWithWhatBeganBeforeTheyWereJoined) {
  truth_t truth{};
  truth.fog_present = 1;
  truth.collision = truth_t::COLLISION_HOST;
  arbitration_t command{};
  command.doc = 0.8;
  command.threshold = 0.5;
  for (const std::int64_t first : {0, 300}) {
    RunEvents events;
    truth.header.step = command.header.step = first;
    events.Add(truth);
    events.Add(command, std::nullopt);
    EXPECT_EQ(events.events().size(), first == 0 ? 3U : 0U);
    // What ends afterwards is an event in both cases.
    truth_t clear = truth;
    clear.fog_present = 0;
    clear.header.step = first + 1;
    events.Add(clear);
    ASSERT_FALSE(events.events().empty());
    EXPECT_EQ(events.events().back().text, "fog ends");
  }
}

TEST(RunEventsTest, BeginWithTheRequestInWhichTheyWereJoined) {
  RunEvents events;
  arbitration_t command{};
  command.threshold = 0.5;
  command.header.step = 300;
  command.mode = arbitration_t::REQUEST;
  events.Add(command, std::nullopt);
  ASSERT_EQ(events.events().size(), 1U);
  EXPECT_EQ(events.events()[0].text, "state DEMAND");
  EXPECT_EQ(events.events()[0].kind, "request");
}

}  // namespace
}  // namespace fogline::web
