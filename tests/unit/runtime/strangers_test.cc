#include "services/runtime/strangers.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace fogline {
namespace {

status_t Status(std::int64_t run_id, const std::string& role, std::int32_t pid,
                const std::string& host) {
  status_t status{};
  status.header.run_id = run_id;
  status.role = role;
  status.pid = pid;
  status.host = host;
  return status;
}

TEST(StrangersTest, AreNamedOnceEach) {
  Strangers strangers;
  EXPECT_EQ(strangers.Text(), "");
  strangers.Hear(Status(123, "fusion", 4711, "lab2"));
  strangers.Hear(Status(123, "fusion", 4711, "lab2"));
  EXPECT_EQ(strangers.Text(), "ignored: fusion (pid 4711 on lab2) of run 123");
  strangers.Hear(Status(124, "fusion", 4711, "lab2"));
  EXPECT_EQ(strangers.known().size(), 2U);
}

TEST(StrangersTest, MustHaveTheNameOfARole) {
  Strangers strangers;
  strangers.Hear(Status(1, "nobody", 1, "here"));
  EXPECT_TRUE(strangers.known().empty());
}

TEST(StrangersTest, CannotWriteToTheTerminal) {
  Strangers strangers;
  strangers.Hear(Status(1, "radar", 1, "\x1b[31m\n\xff" + std::string(1000, 'x')));
  const std::string text = strangers.Text();
  EXPECT_TRUE(std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; })) << text;
  EXPECT_LT(text.size(), 200U);
}

TEST(StrangersTest, AreManyOnlyUpToALimit) {
  Strangers strangers;
  for (int i = 0; i < 10'000; ++i) strangers.Hear(Status(i, "radar", 1, "here"));
  EXPECT_EQ(strangers.known().size(), Strangers::kMax);
  EXPECT_THAT(strangers.Text(), testing::EndsWith("\nignored: more processes of other runs"));
}

TEST(StrangersTest, AreNotHiddenByAFloodOfInventedOnes) {
  // GIVEN a flood of invented processes, and a genuine stale process among them
  Strangers strangers;
  int invented = 0;
  const auto flood = [&] {
    for (int i = 0; i < 1000; ++i) strangers.Hear(Status(++invented, "radar", 1, "nowhere"));
  };
  flood();
  flood();
  for (int second = 0; second < 3; ++second) {
    strangers.Hear(Status(7, "fusion", 4711, "lab2"));
    flood();
  }
  // THEN the text names the genuine one, and the list does not grow
  EXPECT_THAT(strangers.Text(), testing::HasSubstr("ignored: fusion (pid 4711 on lab2) of run 7"));
  EXPECT_EQ(strangers.known().size(), Strangers::kMax);
}

}  // namespace
}  // namespace fogline
