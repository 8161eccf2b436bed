#include "tools/web/server/send_queue.h"

#include <gtest/gtest.h>

#include "tools/web/server/frame_budget.h"

namespace fogline::web {
namespace {

OutgoingFrame OfSize(std::size_t size) { return BinaryFrame(std::string(size, 'x')); }

TEST(SendQueueTest, HoldsAtMost8MiB) {
  SendQueue queue;
  constexpr std::size_t kMebibyte = 1 << 20;
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(queue.Push(OfSize(kMebibyte)));
  EXPECT_EQ(queue.bytes(), SendQueue::kMostBytes);
  EXPECT_FALSE(queue.Push(OfSize(1)));
  EXPECT_EQ(queue.bytes(), SendQueue::kMostBytes);
  queue.Pop();
  EXPECT_TRUE(queue.Push(OfSize(1)));
  EXPECT_EQ(queue.bytes(), 7 * kMebibyte + 1);
}

TEST(SendQueueTest, TakesAnyFrameIfItIsEmpty) {
  SendQueue queue;
  EXPECT_TRUE(queue.Push(OfSize(SendQueue::kMostBytes + 1)));
  EXPECT_FALSE(queue.Push(OfSize(0)));
  queue.Pop();
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.bytes(), 0U);
}

TEST(SendQueueTest, GivesFramesInTheirOrder) {
  SendQueue queue;
  EXPECT_TRUE(queue.Push(TextFrame("a")));
  EXPECT_TRUE(queue.Push(BinaryFrame("b")));
  EXPECT_EQ(*queue.front().bytes, "a");
  EXPECT_FALSE(queue.front().binary);
  queue.Pop();
  EXPECT_EQ(*queue.front().bytes, "b");
  EXPECT_TRUE(queue.front().binary);
}

TEST(SendQueueTest, KeepsTheFrameThatIsBeingSent) {
  SendQueue queue;
  for (const char* text : {"aa", "b", "c"}) EXPECT_TRUE(queue.Push(TextFrame(text)));
  queue.Clear(true);
  EXPECT_EQ(queue.bytes(), 2U);
  EXPECT_EQ(*queue.front().bytes, "aa");
  queue.Clear(false);
  EXPECT_TRUE(queue.empty());
}

TEST(FrameBudgetTest, AllowsABurstAndThenTheRate) {
  TimePoint now{};
  FrameBudget budget(now);
  for (int i = 0; i < 200; ++i) EXPECT_TRUE(budget.Take(now)) << i;
  EXPECT_FALSE(budget.Take(now));
  now += milliseconds(500);
  int taken = 0;
  while (budget.Take(now)) ++taken;
  EXPECT_NEAR(taken, 100, 1);
}

TEST(FrameBudgetTest, SavesNoMoreThanABurst) {
  TimePoint now{};
  FrameBudget budget(now);
  now += milliseconds(3'600'000);
  int taken = 0;
  while (budget.Take(now)) ++taken;
  EXPECT_EQ(taken, 200);
}

}  // namespace
}  // namespace fogline::web
