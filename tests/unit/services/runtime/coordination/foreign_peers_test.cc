#include "services/runtime/coordination/foreign_peers.h"

#include <gmock/gmock.h>
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

TEST(ForeignPeersTest, AreNamedOnceEach) {
  runtime::ForeignPeers foreign_peers;
  EXPECT_EQ(foreign_peers.Text(), "");
  foreign_peers.Hear(Status(123, "fusion", 4711, "lab2"));
  foreign_peers.Hear(Status(123, "fusion", 4711, "lab2"));
  EXPECT_EQ(foreign_peers.Text(), "ignored: fusion (pid 4711 on lab2) of run 123");
  foreign_peers.Hear(Status(124, "fusion", 4711, "lab2"));
  EXPECT_EQ(foreign_peers.known().size(), 2U);
}

TEST(ForeignPeersTest, MustHaveTheNameOfARole) {
  runtime::ForeignPeers foreign_peers;
  foreign_peers.Hear(Status(1, "pilot", 1, "here"));
  EXPECT_TRUE(foreign_peers.known().empty());
}

TEST(ForeignPeersTest, CannotWriteToTheTerminal) {
  runtime::ForeignPeers foreign_peers;
  foreign_peers.Hear(Status(1, "radar", 1, "\x1b[31m\n\xff" + std::string(1000, 'x')));
  const std::string text = foreign_peers.Text();
  EXPECT_TRUE(std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; })) << text;
  EXPECT_LT(text.size(), 200U);
}

TEST(ForeignPeersTest, AreManyOnlyUpToALimit) {
  runtime::ForeignPeers foreign_peers;
  for (int i = 0; i < 10'000; ++i) foreign_peers.Hear(Status(i, "radar", 1, "here"));
  EXPECT_EQ(foreign_peers.known().size(), runtime::ForeignPeers::kMax);
  EXPECT_THAT(foreign_peers.Text(), testing::EndsWith("\nignored: more processes of other runs"));
}

TEST(ForeignPeersTest, AreNotHiddenByAFloodOfInventedOnes) {
  // GIVEN a flood of invented processes, and a genuine stale process among them
  runtime::ForeignPeers foreign_peers;
  int invented = 0;
  const auto flood = [&] {
    for (int i = 0; i < 1000; ++i) foreign_peers.Hear(Status(++invented, "radar", 1, "nowhere"));
  };
  flood();
  flood();
  for (int second = 0; second < 3; ++second) {
    foreign_peers.Hear(Status(7, "fusion", 4711, "lab2"));
    flood();
  }
  // THEN the text names the genuine process, and the list does not grow
  EXPECT_THAT(foreign_peers.Text(),
              testing::HasSubstr("ignored: fusion (pid 4711 on lab2) of run 7"));
  EXPECT_EQ(foreign_peers.known().size(), runtime::ForeignPeers::kMax);
}

}  // namespace
}  // namespace fogline
